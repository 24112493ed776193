// SPDX-License-Identifier: LGPL-2.1-or-later
// Starts pipelines with a foxglovesink, and opens their page in Debian's Chromium.
import { spawn } from 'node:child_process';
import net from 'node:net';
import { chromium } from 'playwright-core';

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** A port that is free now. */
export function freePort() {
  return new Promise((done) => {
    const server = net.createServer();
    server.listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
}

/** Waits until `question()` returns a true value, and returns it; throws after `patienceMs`. */
export async function until(what, question, patienceMs = 60_000) {
  const end = Date.now() + patienceMs;
  for (;;) {
    const answer = await question();
    if (answer) return answer;
    if (Date.now() > end) throw new Error(`did not happen: ${what}`);
    await sleep(100);
  }
}

const canConnect = (port) =>
  new Promise((done) => {
    const socket = net.connect(port, '127.0.0.1');
    socket.on('connect', () => done(socket.destroy() && true));
    socket.on('error', () => done(false));
  });

const running = new Set();

/** A gst-launch-1.0 whose foxglovesink listens on `port`. */
export class Pipeline {
  static async start(description, port) {
    const child = spawn('gst-launch-1.0', ['-q', ...description.split(/\s+/)], {
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    const pipeline = new Pipeline(child);
    child.stdout.on('data', (text) => (pipeline.output += text));
    child.stderr.on('data', (text) => (pipeline.output += text));
    await until(`a server on port ${port}: ${description}`, () => {
      if (child.exitCode !== null) throw new Error(`${description}\n${pipeline.output}`);
      return canConnect(port);
    });
    return pipeline;
  }

  constructor(child) {
    this.child = child;
    this.output = '';
    this.ended = new Promise((done) => child.on('exit', done));
    running.add(this);
  }

  async stop() {
    this.child.kill('SIGINT');
    const timer = setTimeout(() => this.child.kill('SIGKILL'), 10_000);
    await this.ended;
    clearTimeout(timer);
    running.delete(this);
  }

  /** Stops pipelines of tests that failed: they would keep Node running. */
  static stopAll() {
    return Promise.all([...running].map((pipeline) => pipeline.stop()));
  }
}

/** Chromium that draws by software. */
export const openBrowser = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });

/** Opens `url`; warnings and errors of the page collect in `complaints`. */
export async function openPage(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  context.setDefaultTimeout(120_000);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (m) => ['error', 'warning'].includes(m.type()) && complaints.push(m.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(url);
  return { page, context, complaints };
}
