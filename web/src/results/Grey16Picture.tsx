import { Alert, Text } from '@mantine/core';
import { useEffect, useRef, useState } from 'react';
import { useTranslation } from 'react-i18next';

import { limits, readGrey16, type Grey16 } from './png16';

/** A 16-bit picture in grey, spread over the range of its values. */
export function Grey16Picture({ file, label }: { file: Uint8Array; label: string }) {
  const { t } = useTranslation('results');
  const canvas = useRef<HTMLCanvasElement>(null);
  const [range, setRange] = useState({ least: 0, greatest: 0 });
  const [failure, setFailure] = useState('');

  useEffect(() => {
    let here = true;
    readGrey16(file).then(
      (picture) => {
        if (!here || !canvas.current) return;
        setRange(limits(picture));
        draw(picture, canvas.current);
      },
      (error: unknown) => here && setFailure(String(error)),
    );
    return () => {
      here = false;
    };
  }, [file]);

  if (failure !== '') return <Alert color="red">{t('fileFailed', { field: label, message: failure })}</Alert>;
  return (
    <figure style={{ margin: 0 }}>
      <canvas ref={canvas} role="img" aria-label={label} style={{ maxWidth: '100%' }} />
      <Text component="figcaption" size="sm">
        {t('range16', range)}
      </Text>
    </figure>
  );
}

function draw(picture: Grey16, canvas: HTMLCanvasElement): void {
  const { widthPx, heightPx, values } = picture;
  const { least, greatest } = limits(picture);
  canvas.width = widthPx;
  canvas.height = heightPx;
  const image = new ImageData(widthPx, heightPx);
  const pixels = new Uint32Array(image.data.buffer);
  const scale = 215 / Math.max(greatest - least, 1);
  values.forEach((value, i) => {
    const grey = value === 0 ? 0 : 40 + Math.round((value - least) * scale);
    pixels[i] = 0xff000000 | (grey * 0x010101);
  });
  canvas.getContext('2d')?.putImageData(image, 0, 0);
}
