// SPDX-License-Identifier: LGPL-2.1-or-later
// Puts the page together: what comes from the server goes to the scene and the charts.
import './style.css';
import { Charts } from './charts.js';
import { Connection } from './connection.js';
import { fromDraco, unpack } from './fields.js';
import { Poses } from './poses.js';
import { Scene } from './scene.js';
import { buildTools } from './tools.js';
import { compressedCloud, frameTransform, pointCloud } from './wire.js';

const STALLED_MS = 2000;
const SLOW_DRAW_MS = 250;
const BUSY_MS = 100;

const page = {
  state: 'connecting',
  paused: false,
  quietMs: 0, // since the last cloud
  clouds: 0, // since the last count
  points: 0,
  bytes: 0,
  received: {}, // by schema, since the start
  spanS: 0.1,
  charts: new Charts(document.getElementById('charts')),
  scene: new Scene(document.getElementById('scene')),
  poses: new Poses(),
};
const tools = buildTools(page);

// --- clouds ---

let draco = null;
const waiting = new Map(); // clouds that the worker has

function decodeDraco(cloud) {
  if (!draco) {
    draco = new Worker(new URL('draco_worker.js', document.baseURI));
    draco.onmessage = ({ data: { id, positions, intensities } }) => {
      const sent = waiting.get(id);
      waiting.delete(id);
      if (sent && positions) addCloud(sent, fromDraco(positions, intensities));
    };
  }
  if (waiting.size > 64) waiting.clear(); // it is slower than the stream: the newest counts
  page.dracoId = (page.dracoId ?? 0) + 1;
  waiting.set(page.dracoId, { time: cloud.time, frame: cloud.frame });
  const data = cloud.data.slice().buffer;
  draco.postMessage({ id: page.dracoId, data }, [data]);
}

function addCloud({ time, frame }, { points, has }) {
  page.quietMs = 0;
  ++page.clouds;
  page.points += points.length / 6;
  if (page.paused) return;
  tools.learn(points, has);
  const matrix = page.poses.at(frame, time);
  tools.hasPoses(matrix !== null);
  page.scene.add(points, time, matrix);
}

function onStatistics(message) {
  page.statistics = message;
  const sink = Object.values(message.elements ?? {}).find((e) => e.factory === 'foxglovesink');
  if (sink?.scan_duration > 0 && !page.paused) page.spanS = sink.scan_duration * 1e-9;
  tools.setSpan();
  page.charts.add({ ...message, received: page.receivedBps });
}

const handlers = {
  'foxglove.PointCloud': (bytes) => {
    const cloud = pointCloud(bytes);
    addCloud(cloud, unpack(cloud));
  },
  'foxglove.CompressedPointCloud': (bytes) => decodeDraco(compressedCloud(bytes)),
  'foxglove.FrameTransform': (bytes) => page.poses.add(frameTransform(bytes)),
  'lidar.Statistics': (bytes) => onStatistics(JSON.parse(new TextDecoder().decode(bytes))),
};

// --- states ---

const STATES = {
  connecting: ['Connecting', ''],
  live: ['Live', ''],
  stalled: ['No clouds', 'Connected, but no cloud has come for two seconds.'],
  lost: ['Connection lost', 'The server does not answer. Trying again.'],
  refused: ['Not admitted', 'The token is missing or wrong.'],
  full: ['Server is full', 'Too many viewers are connected. Trying again.'],
};

function setState(state) {
  page.state = state;
  document.body.dataset.state = state;
  const [name, text] = STATES[state];
  document.querySelector('#state span').textContent = page.paused ? `${name}, paused` : name;
  const notice = document.getElementById('notice');
  notice.hidden = text === '';
  notice.textContent = text;
}
page.showState = () => setState(page.state);

function checkFlow() {
  if (page.state !== 'live' && page.state !== 'stalled') return;
  const quiet = page.quietMs > STALLED_MS;
  if (quiet !== (page.state === 'stalled')) setState(quiet ? 'stalled' : 'live');
}

let counted = performance.now();
function countSecond() {
  const now = performance.now();
  const seconds = (now - counted) / 1000;
  counted = now;
  page.receivedBps = (page.bytes * 8) / seconds;
  const perSecond = Math.round(page.points / seconds);
  const live = page.state === 'live';
  document.getElementById('facts').textContent = live
    ? `${perSecond.toLocaleString('en')} points/s · ${(page.receivedBps * 1e-6).toFixed(1)} Mbit/s`
    : '';
  page.bytes = page.points = page.clouds = 0;
}

// --- connection ---

function tokenOf() {
  const url = new URL(location.href);
  const given = url.searchParams.get('token');
  if (given === null) return sessionStorage.getItem('token') ?? '';
  // It need not stay where others can read it.
  sessionStorage.setItem('token', given);
  url.searchParams.delete('token');
  history.replaceState(null, '', url);
  return given;
}

function askForToken() {
  const dialog = document.getElementById('entry');
  dialog.showModal();
  dialog.onclose = () => {
    sessionStorage.setItem('token', document.getElementById('token').value);
    connect();
  };
}

function connect() {
  const on = {
    state: (state) => {
      if (state === 'open') page.quietMs = 0;
      if (state === 'lost') page.poses.clear();
      if (state === 'connecting' && page.state !== 'connecting') return; // still lost
      setState(state === 'open' ? 'live' : state);
      if (state === 'refused') askForToken();
    },
    message: (channel, bytes) => {
      page.bytes += bytes.length;
      const received = (page.received[channel.schemaName] ??= { messages: 0, bytes: 0 });
      ++received.messages;
      received.bytes += bytes.length;
      handlers[channel.schemaName](bytes);
    },
  };
  page.connection = new Connection(location.host, tokenOf(), on, (c) => c.schemaName in handlers);
}

/** Statistics of another pipeline, such as the sender's: ?also=robot:8765. */
function connectOthers() {
  for (const host of new URL(location.href).searchParams.getAll('also')) {
    const on = {
      state: () => {},
      message: (_, bytes) => onStatistics(JSON.parse(new TextDecoder().decode(bytes))),
    };
    new Connection(host, '', on, (c) => c.schemaName === 'lidar.Statistics');
  }
}

// --- the loop ---

let drawn = 0;
let drawnCharts = 0;
function frame(now) {
  page.scene.draw();
  // Where the browser itself was busy, clouds may have come that it has not told of yet.
  page.quietMs += Math.min(now - drawn, BUSY_MS);
  drawn = now;
  if (now - drawnCharts > SLOW_DRAW_MS) {
    drawnCharts = now;
    page.charts.draw(tools.style());
    checkFlow();
  }
  requestAnimationFrame(frame);
}

setState('connecting');
connect();
connectOthers();
setInterval(countSecond, 1000);
requestAnimationFrame(frame);
window.lidarPage = page; // for the browser's console, and for tests
