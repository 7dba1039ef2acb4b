// Whether a page fits its window.
import assert from 'node:assert/strict';

/**
 * Nothing makes the page itself scroll sideways, and every control can be seen without that: it lies
 * between the edges of the window and of all that clips it. Wide tables may scroll by themselves.
 */
export async function assertFits(page, name) {
  const faults = await page.evaluate(() => {
    const root = document.documentElement;
    const found = [];
    const tooWide = root.scrollWidth - root.clientWidth;
    if (tooWide > 0) found.push(`the page is ${tooWide} px wider than the window`);

    const clips = (element) => getComputedStyle(element).overflowX !== 'visible';
    const scrollsSideways = (element) => ['auto', 'scroll'].includes(getComputedStyle(element).overflowX);
    const controls = document.querySelectorAll('button, a[href], input, select, textarea, [role="tab"]');
    for (const control of controls) {
      if (!control.checkVisibility({ visibilityProperty: true })) continue;
      const { left, right, width } = control.getBoundingClientRect();
      if (width <= 1) continue; // only for screen readers
      let [from, to] = [0, root.clientWidth];
      for (let around = control.parentElement; around && around !== root; around = around.parentElement) {
        if (scrollsSideways(around) && around.getAttribute('role') === 'region') {
          [from, to] = [-Infinity, Infinity];
          break;
        }
        if (!clips(around)) continue;
        const box = around.getBoundingClientRect();
        [from, to] = [Math.max(from, box.left), Math.min(to, box.right)];
      }
      if (left < from - 1 || right > to + 1) {
        const label = control.getAttribute('aria-label') ?? control.textContent.trim();
        found.push(`${control.localName} "${label}" from ${Math.round(left)} to ${Math.round(right)} px, seen from ${from} to ${to}`);
      }
    }
    return found;
  });
  assert.deepEqual(faults, [], `what does not fit on ${name}`);
}
