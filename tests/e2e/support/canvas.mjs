// What is on the canvas of a map, as the user sees it.
import { until } from './browser.mjs';

const map = (page) => page.getByTestId('view-map');

/** The number of the frame that is on the screen; 0 before the first. */
export async function shownFrame(page) {
  return Number((await map(page).getAttribute('data-frame')) ?? 0);
}

/**
 * Waits until another frame is on the screen than when it was called; gives its number. A newer one,
 * unless the sequence was started anew and counts from 1 again.
 */
export async function waitForNextFrame(page, { startedAnew = false } = {}) {
  const before = await shownFrame(page);
  return until('another picture', async () => {
    const now = await shownFrame(page);
    return (startedAnew ? now !== before : now > before) && now;
  });
}

/** The pixels of the map as they are on the screen; `at` gives red, of the middle of a pixel. */
export async function shownPixels(page) {
  const { bytes, ...shown } = await map(page).evaluate(async (canvas) => {
    // A page that is just laid out anew has not yet painted what its size says.
    const animationFrame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    const look = () => {
      const { clientWidth, clientHeight, width, height, dataset } = canvas;
      return JSON.stringify([clientWidth, clientHeight, width, height, dataset.left, dataset.top, dataset.scale]);
    };
    for (let before = ''; before !== look(); await animationFrame(), await animationFrame()) before = look();
    const copy = document.createElement('canvas');
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let bytes = '';
    for (let i = 0; i < data.length; i += 4) bytes += String.fromCharCode(data[i]);
    const { left, top, scale } = canvas.dataset;
    return {
      bytes: btoa(bytes),
      canvasWidth: canvas.width,
      ratio: window.devicePixelRatio,
      left: Number(left),
      top: Number(top),
      scale: Number(scale),
      cssWidth: canvas.clientWidth,
      cssHeight: canvas.clientHeight,
    };
  });
  const red = Buffer.from(bytes, 'base64');
  const { left, top, scale, ratio, canvasWidth } = shown;
  return {
    width: Math.round((shown.cssWidth - 2 * left) / scale),
    height: Math.round((shown.cssHeight - 2 * top) / scale),
    at: (x, y) => {
      const column = Math.floor((left + (x + 0.5) * scale) * ratio);
      const row = Math.floor((top + (y + 0.5) * scale) * ratio);
      return red[row * canvasWidth + column];
    },
  };
}

/** An element as it is on the screen; `at` gives red, green and blue of a CSS pixel of it. */
export async function screenPixels(page, element) {
  const file = await element.screenshot();
  const { width, height, bytes } = await page.evaluate(async (packed) => {
    const png = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([png], { type: 'image/png' }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data, width, height } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let bytes = '';
    for (let i = 0; i < data.length; i += 4096) bytes += String.fromCharCode(...data.subarray(i, i + 4096));
    return { width, height, bytes: btoa(bytes) };
  }, file.toString('base64'));
  const rgba = Buffer.from(bytes, 'base64');
  const at = (x, y) => rgba.subarray(4 * (y * width + x), 4 * (y * width + x) + 3);
  const all = () => Array.from({ length: width * height }, (_, i) => rgba.subarray(4 * i, 4 * i + 3));
  return { width, height, at, all };
}
