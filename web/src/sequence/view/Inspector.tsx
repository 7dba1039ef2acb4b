import { VisuallyHidden } from '@mantine/core';
import { useEffect, useRef } from 'react';
import { useTranslation } from 'react-i18next';
import { number } from './format';
import { readingAt } from './reading';
import type { Scene } from './scene';
import classes from './view.module.css';

const fields = ['x', 'y', 'grey', 'disparity', 'depth', 'X', 'Y', 'Z', 'reason'] as const;
type Field = (typeof fields)[number];

// Keys repeat; only where the crosshair comes to rest is spoken.
const kSpeakAfterMs = 400;

/** All that is known of the pixel under the pointer or crosshair, as it changes from frame to frame. */
export function Inspector({ scene }: { scene: Scene }) {
  const { t, i18n } = useTranslation('sequence');
  const spoken = useRef<HTMLDivElement>(null);
  const cells = useRef<Partial<Record<Field, HTMLElement | null>>>({});

  useEffect(() => {
    const write = () => {
      const texts = textsOf(scene, i18n.language, (reason) => t(`reason.${reason}`));
      for (const field of fields) {
        const cell = cells.current[field];
        const text = texts[field] ?? '–';
        if (cell && cell.textContent !== text) cell.textContent = text;
      }
    };
    write();
    const endings = [scene.mapChanged, scene.pictureChanged, scene.cursorChanged].map((signal) =>
      signal.on(write),
    );
    return () => endings.forEach((end) => end());
  }, [scene, t, i18n.language]);

  // For screen readers: the pixel that was chosen, once, and not each frame of it.
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    const speak = () => {
      clearTimeout(timer);
      timer = setTimeout(() => {
        const { x, y, depth, reason } = textsOf(scene, i18n.language, (one) => t(`reason.${one}`));
        if (!spoken.current || x === undefined || y === undefined) return;
        spoken.current.textContent = `x ${x}, y ${y}: ${depth ?? reason ?? '–'}`;
      }, kSpeakAfterMs);
    };
    const end = scene.pinned.on(speak);
    return () => {
      clearTimeout(timer);
      end();
    };
  }, [scene, t, i18n.language]);

  return (
    <>
      <VisuallyHidden ref={spoken} role="status" />
      <dl className={classes.inspector} data-testid="inspector">
        {fields.map((field) => (
          <div key={field} data-field={field}>
            <dt>{t(`inspector.${field}`)}</dt>
            <dd
              ref={(element) => {
                cells.current[field] = element;
              }}
              data-testid={`inspector-${field}`}
            >
              –
            </dd>
          </div>
        ))}
      </dl>
    </>
  );
}

/** The texts of the fields that have a value. */
export function textsOf(
  scene: Pick<Scene, 'map' | 'picture' | 'cursor' | 'colorAt'>,
  locale: string,
  inWords: (reason: NonNullable<ReturnType<typeof readingAt>>['reason'] & string) => string,
): Partial<Record<Field, string>> {
  const { cursor, map, picture } = scene;
  if (!cursor) return {};
  const texts: Partial<Record<Field, string>> = {
    x: `${cursor.x} px`,
    y: `${cursor.y} px`,
  };
  const color = picture && scene.colorAt?.(cursor);
  if (color) {
    const [red, green, blue] = color;
    const value = red === green && green === blue ? String(red) : `${red} ${green} ${blue}`;
    // A packed picture is nearly, but not quite, what the camera gave.
    texts.grey = picture.exact ? value : `≈ ${value}`;
  }
  const reading = map && readingAt(map, cursor);
  if (!reading) return texts;
  if (reading.disparity_px !== undefined) {
    texts.disparity = `${number(reading.disparity_px, 2, locale)} px`;
  }
  if (reading.depth_m !== undefined) texts.depth = `${number(reading.depth_m, 4, locale)} m`;
  if (reading.point) {
    texts.X = `${number(reading.point.x_m, 4, locale)} m`;
    texts.Y = `${number(reading.point.y_m, 4, locale)} m`;
    texts.Z = `${number(reading.point.z_m, 4, locale)} m`;
  }
  if (reading.reason) texts.reason = inWords(reading.reason);
  return texts;
}
