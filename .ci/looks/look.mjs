// A browser looks at what the program makes: node look.mjs FOLDER, with house/report.html, book/index.html and plots in it.
// At the width of a desk and of a phone, on a light screen and on a dark one: nothing axe finds wrong, no letters below 11 px, nothing
// wider than the screen, no error of a script, nothing asked of anybody; then the report is used: dragged, typed at, played.
import { readdirSync, readFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const LEAST_PX = 11, WIDTHS = [1280, 390], SCREENS = ['light', 'dark'];
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const folder = resolve(process.argv[2]);
const complaints = [];
const complain = (where, what) => complaints.push(`${where}: ${what}`);

// letters below the least, as they are shown
const small = least => {
  const found = [];
  const walk = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_TEXT);
  for (let node; (node = walk.nextNode());) {
    const element = node.parentElement;
    if (!node.textContent.trim() || ['script', 'style', 'title', 'desc'].includes(element.tagName.toLowerCase())) continue;
    if (!element.getBoundingClientRect().width) continue;
    const matrix = element.ownerSVGElement ? element.getScreenCTM() : null;
    const px = parseFloat(getComputedStyle(element).fontSize) * (matrix ? Math.hypot(matrix.b, matrix.d) : 1);
    if (px < least - 0.01) found.push(`${px.toFixed(1)} px “${node.textContent.trim().slice(0, 24)}”`);
  }
  return found;
};

const look = async (context, file, width, screen) => {
  const where = `${file}, ${width} px, ${screen}`, page = await context.newPage();
  page.on('pageerror', error => complain(where, error.message));
  page.on('request', request => /^(file|data|blob):/.test(request.url()) || complain(where, `asks for ${request.url()}`));
  await page.setViewportSize({ width, height: 900 });
  await page.emulateMedia({ colorScheme: screen });
  await page.goto(pathToFileURL(join(folder, file)).href);
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  violations.forEach(v => complain(where, `${v.id}, ${v.nodes.length} times: ${v.nodes[0].html.slice(0, 160)}`));
  const letters = await page.evaluate(small, LEAST_PX);
  if (letters.length) complain(where, `${letters.length} words in letters below ${LEAST_PX} px: ${letters.slice(0, 5).join(', ')}`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > width) complain(where, `${wide} px wide`);
  return page;
};

const use = async page => {
  const where = 'house/report.html, used';
  const areas = page.locator('.area'), count = await areas.count();
  const views = () => page.$$eval('.area > svg', all => all.map(svg => svg.getAttribute('viewBox')));
  const now = () => page.$eval('#time', slider => +slider.value);
  const check = (holds, what) => holds || complain(where, what);
  const whole = await views();
  check(count >= 7, `${count} diagrams`);
  const drag = async () => {
    await areas.nth(1).scrollIntoViewIfNeeded();
    const box = await areas.nth(1).boundingBox(), y = box.y + box.height / 2;
    await page.mouse.move(box.x + 0.3 * box.width, y);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.4 * box.width, y, { steps: 4 });
    await page.mouse.up();
  };
  await drag();
  const closer = await views();
  check(closer.every((view, i) => view !== whole[i]), 'not all diagrams look closer where one is dragged over');
  check(closer.every(view => Math.abs(view.split(' ')[2] - 100) < 10), `a tenth is asked for, and shown are ${closer}`);
  const lines = await page.$$eval('.area path[data-v]', all => all.filter(path => /NaN|undefined/.test(path.getAttribute('d'))).length);
  check(lines === 0, `${lines} curves are drawn with what is no number`);
  await areas.nth(1).dblclick();
  check((await views()).join() === (await views()).join() && (await views()).every(view => view.split(' ')[2] > 990), 'a double click does not show the whole');
  await areas.nth(2).focus();
  const before = await now();
  for (let i = 0; i < 5; i++) await page.keyboard.press('Shift+ArrowRight');
  check(await now() > before, 'the cursor does not follow the arrow keys');
  await page.keyboard.press('+');
  check((await views())[2].split(' ')[2] < 600, 'plus does not look closer');
  await page.keyboard.press('Escape');
  const at = await now();
  await page.locator('#play').click();
  await page.waitForTimeout(600);
  await page.locator('#play').click();
  check(await now() > at + 0.2, 'it does not play');
  const ground = () => page.$eval('.paper', paper => getComputedStyle(paper).backgroundColor);
  const day = await ground();
  await page.locator('.wall-switch').first().click();
  check(await ground() !== day, 'the wall does not turn dark');
  const drawn = await page.evaluate(() => {
    const plot = document.querySelectorAll('.area')[1], box = plot.getBoundingClientRect();
    const send = (type, x) => plot.dispatchEvent(new PointerEvent(type, { clientX: box.left + x * box.width, pointerId: 1, button: 0 }));
    plot.setPointerCapture = () => {};
    const began = performance.now();
    send('pointerdown', 0.1); send('pointermove', 0.9); send('pointerup', 0.9);
    return performance.now() - began;
  });
  console.log(`a stretch of the run is drawn anew, in ${count} diagrams, in ${drawn.toFixed(0)} ms`);
};

const profile = mkdtempSync(join(tmpdir(), 'looks-'));
const context = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, bypassCSP: true,
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
try {
  // a plot is looked at as a page shows it: inside one
  const plots = readdirSync(folder).filter(name => name.endsWith('.svg'));
  for (const name of plots) {
    const page = `<!doctype html><html lang="en"><title>${name}</title><main><h1>${name}</h1><div tabindex="0" style="overflow:auto">` +
      `${readFileSync(join(folder, name), 'utf8').replace(/^[^]*?<svg/, '<svg')}</div></main></html>`;
    writeFileSync(join(folder, `${name}.html`), page);
  }
  const files = ['house/report.html', 'book/index.html', ...plots.map(name => `${name}.html`)];
  for (const file of files) for (const width of WIDTHS) for (const screen of SCREENS) {
    const page = await look(context, file, width, screen);
    if (file === 'house/report.html' && width === 1280 && screen === 'light') await use(page);
    await page.close();
  }
  console.log(`${files.length} pages looked at, at ${WIDTHS.join(' and ')} px, light and dark`);
} finally {
  await context.close();
  rmSync(profile, { recursive: true, force: true });
}
if (complaints.length) {
  console.error(complaints.join('\n'));
  process.exit(1);
}
