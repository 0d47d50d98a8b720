// The page in headless Chromium, served by the installed command: node page_test.mjs NODE_MODULES_PARENT SCREENSHOTS
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [web, screenshots] = process.argv.slice(2);
const { RILO_BIN: rilo, CHROMIUM: chromium } = process.env;
if (!chromium || !existsSync(chromium)) {
  console.log('skipped: no chromium (scripts/setup.sh --browser installs it)');
  process.exit(77);
}
const { chromium: playwright } = createRequire(join(web, 'package.json'))('playwright-core');

const SWEEPS = 60;
const folder = mkdtempSync(join(tmpdir(), 'rilo-view-'));
let failures = 0;
let server;

function check(condition, what) {
  console.log(`${condition ? 'ok  ' : 'FAIL'} ${what}`);
  if (!condition) ++failures;
}

function command(...args) {
  const { status, stderr } = spawnSync(rilo, args, { encoding: 'utf8' });
  if (status !== 0) throw new Error(`rilo ${args.join(' ')}: ${status}\n${stderr}`);
}

/// Starts a command that serves the page; its address.
function serve(...args) {
  server = spawn(rilo, args, { stdio: ['ignore', 'ignore', 'pipe'] });
  return new Promise((resolve, reject) => {
    let text = '';
    server.stderr.on('data', (part) => {
      text += part;
      const address = text.match(/http:\/\/\S+/);
      if (address) resolve(address[0]);
    });
    server.on('exit', () => reject(new Error(text)));
  });
}

/// Ctrl-C; the exit code.
function stop() {
  return new Promise((resolve) => {
    server.removeAllListeners('exit');
    server.on('exit', (code) => resolve(code));
    server.kill('SIGINT');
  });
}

const state = (page) => page.evaluate(() => {
  const { run, map, rate } = globalThis.viewer;
  return { shown: run.shown, records: run.records.length, map: map.count, drawn: rate.drawn, sweep: run.sweep?.number ?? -1,
    finished: run.progress.finished };
});

/// How many different colours, and how many pixels that are not the ground, the picture has: drawn by the page itself.
const pixels = (page) => page.evaluate(() => {
  const { stage } = globalThis.viewer;
  stage.render();
  const gl = stage.renderer.getContext();
  const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  const words = new Uint32Array(bytes.buffer);
  const counts = new Map();
  for (const word of words) counts.set(word, (counts.get(word) ?? 0) + 1);
  return { colours: counts.size, drawn: 1 - Math.max(...counts.values()) / words.length };
});

async function open(browser, address, options = {}) {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options })).newPage();
  page.problems = [];
  page.on('console', (message) => {
    // A software renderer is slow, and says so when pixels are read.
    if (['error', 'warning'].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text())) {
      page.problems.push(message.text());
    }
  });
  page.on('pageerror', (error) => page.problems.push(String(error)));
  await page.goto(address);
  await page.waitForFunction(() => globalThis.viewer?.run.sweep && globalThis.viewer.map.count > 0);
  return page;
}

const overlap = (page) => page.evaluate(() => {
  const boxes = ['facts', 'key', 'legend', 'rate'].map((id) => [id, document.getElementById(id).getBoundingClientRect()]);
  const bad = [];
  for (const [a, p] of boxes) {
    if (p.left < 0 || p.right > innerWidth + 0.5) bad.push(`${a} leaves the page`);
    for (const [b, q] of boxes) {
      if (a < b && p.left < q.right && q.left < p.right && p.top < q.bottom && q.top < p.bottom) bad.push(`${a} over ${b}`);
    }
  }
  if (document.documentElement.scrollWidth > innerWidth) bad.push('wider than the window');
  return bad.join(', ');
});

async function pictures(browser, address) {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    for (const colorScheme of ['dark', 'light']) {
      const page = await open(browser, address, { viewport: { width, height }, colorScheme, reducedMotion: 'reduce' });
      await page.selectOption('#detail', 'all');
      await page.evaluate(() => { const { run } = globalThis.viewer; run.play(false); run.show(45); });
      await page.waitForFunction(() => globalThis.viewer.run.sweep.number === 45 && !globalThis.viewer.stage.dirty);
      const drawn = await pixels(page);
      check(drawn.colours > 50 && drawn.drawn > 0.02, `${width} ${colorScheme}: ${drawn.colours} colours on ${(100 * drawn.drawn).toFixed(0)} %`);
      check((await overlap(page)) === '', `${width} ${colorScheme}: nothing overlaps ${await overlap(page)}`);
      await page.screenshot({ path: join(screenshots, `viewer-${width}-${colorScheme}.png`), fullPage: width < 600 });
      check(page.problems.length === 0, `${width} ${colorScheme}: console ${page.problems.join(' | ') || 'silent'}`);
      await page.context().close();
    }
  }
}

async function playback(browser, address) {
  const page = await open(browser, address);
  await page.waitForFunction((n) => globalThis.viewer.run.records.length === n && globalThis.viewer.run.progress.finished, SWEEPS);
  await page.locator('#scene').focus();
  await page.evaluate(() => globalThis.viewer.run.play(false));
  await page.keyboard.press('Home');
  check((await state(page)).shown === 0, 'Home shows the first sweep');
  await page.keyboard.press('Shift+ArrowRight');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowLeft');
  check((await state(page)).shown === 10, 'arrows step');
  await page.waitForFunction(() => globalThis.viewer.run.sweep.number === 10);
  await page.locator('#seek').fill('33');
  await page.waitForFunction(() => globalThis.viewer.run.sweep.number === 33);
  check((await state(page)).shown === 33, 'the slider seeks, and the points come along');
  await page.locator('#scene').focus();
  await page.keyboard.press('Space');
  await page.waitForFunction(() => globalThis.viewer.run.shown > 35);
  await page.keyboard.press('Space');
  check((await page.evaluate(() => globalThis.viewer.run.playing)) === false, 'Space plays and pauses');
  for (const [key, mode] of [['2', 'intensity'], ['3', 'residual'], ['4', 'time'], ['1', 'height']]) {
    await page.keyboard.press(key);
    const has = await page.evaluate((name) => globalThis.viewer.sweep.has(name), mode);
    check(has || mode === 'time', `the sweep has ${mode}`); // a compensated drive has no times
    check(((await page.inputValue('#colour')) === mode) === has, `coloured by ${mode} where there is any`);
  }
  for (const key of ['t', 'o', 'f', 'm', 'm', 'e', 'e', 'l', 'l', ']', '[', 'a', 'w', '+', '?']) await page.keyboard.press(key);
  check(await page.locator('#keys').isVisible(), '? explains the keys');
  await page.keyboard.press('Escape');
  await page.reload();
  await page.waitForFunction((n) => globalThis.viewer?.run.records.length === n && globalThis.viewer.run.sweep, SWEEPS);
  check((await state(page)).map > 0, 'everything is there again after a reload');
  check(page.problems.length === 0, `console ${page.problems.join(' | ') || 'silent'}`);
  return page;
}

/// A client that shakes hands and then never reads, and one that sends rubbish.
function rudeClients({ host, hostname, port }) {
  const hello = `GET /ws HTTP/1.1\r\nHost: ${host}\r\nOrigin: http://${host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n`
    + 'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n';
  return [Buffer.alloc(0), Buffer.alloc(100000, 0xff), Buffer.from([0x82, 0x88, 0, 0, 0, 0, 9, 9, 9, 9, 9, 9, 9, 9])].map((rubbish) => {
    const socket = connect(Number(port), hostname, () => {
      socket.write(hello);
      socket.write(rubbish);
    });
    socket.on('error', () => {});
    return socket.pause();
  });
}

async function hostile(page, address) {
  const sockets = rudeClients(new URL(address));
  const closed = await page.evaluate(() => new Promise((resolve) => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    socket.onopen = () => socket.send('{"no": "binary"}');
    socket.onclose = ({ code }) => resolve(code);
  }));
  check(closed === 1008, `a page that sends nonsense is closed with ${closed}`);
  await page.evaluate(() => globalThis.viewer.run.show(5));
  await page.waitForFunction(() => globalThis.viewer.run.sweep.number === 5);
  check(true, 'others go on while a client does not read and another one raves');
  sockets.forEach((socket) => socket.destroy());
  await page.evaluate(() => { const { viewer } = globalThis; viewer.layer('choice').checked = false; viewer.layers(); });
  // What the program sends in a wrong form ends the connection, not the page.
  const message = await page.evaluate(() => new Promise((resolve) => {
    const { socket } = globalThis.viewer;
    const before = socket.onState;
    socket.onState = (now, why) => { before(now, why); if (now === 'broken') resolve(why); };
    socket.socket.onmessage({ data: new Uint8Array([4, 1, 7, 0, 255, 255, 255, 255]).buffer });
  }));
  check(/needed/.test(message), `a broken frame is refused: ${message}`);
  await page.waitForFunction((n) => globalThis.viewer.run.records.length === n && globalThis.viewer.run.sweep, SWEEPS);
  check(true, 'the page connects again by itself');
  check(!(await page.evaluate(() => globalThis.viewer.paths.marksWanted)), 'a hidden layer stays hidden then');
}

async function live(browser, drive) {
  const address = await serve('run', drive, '--view=0', '--quiet');
  const page = await open(browser, address);
  await page.waitForFunction((n) => globalThis.viewer.run.progress.finished && globalThis.viewer.run.records.length === n, SWEEPS);
  const { shown, map } = await state(page);
  check(shown === SWEEPS - 1 && map > 0, 'a run is followed to its end');
  check(page.problems.length === 0, `console ${page.problems.join(' | ') || 'silent'}`);
  check((await stop()) === 0, 'Ctrl-C ends it');
}

async function main() {
  const drive = join(folder, 'drive');
  const results = join(folder, 'results');
  command('simulate', '--out', drive, '--sensor', 'vlp16', '--sweeps', String(SWEEPS));
  command('run', drive, '--out', results, '--quiet');
  const browser = await playwright.launch({
    executablePath: chromium,
    args: ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
      '--disable-dev-shm-usage'],
  });
  try {
    const address = await serve('view', results, '--port', '0');
    const page = await playback(browser, address);
    await hostile(page, address);
    await page.context().close();
    await pictures(browser, address);
    check((await stop()) === 0, 'Ctrl-C ends the replay');
    await live(browser, drive);
  } finally {
    await browser.close();
  }
}

try {
  await main();
} catch (error) {
  console.log(`FAIL ${error.stack}`);
  ++failures;
} finally {
  server?.kill('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failures === 0 ? 0 : 1);
