// SPDX-License-Identifier: LGPL-2.1-or-later
// Puts the page together: passes messages of the server to the scene and the charts.
import './style.css';
import { Charts } from './charts.js';
import { chooseChannels, robotsOf } from './channels.js';
import { nowSeconds } from './clock.js';
import { Connection } from './connection.js';
import { fromDraco, unpack } from './fields.js';
import { Links } from './links.js';
import { Poses } from './poses.js';
import { Replay } from './replay.js';
import { Scene } from './scene.js';
import { Slices } from './slices.js';
import { language, number, t, translate } from './text.js';
import { Timeline } from './timeline.js';
import { buildTools } from './tools.js';
import { Video } from './video.js';
import { compressedCloud, compressedVideo, frameTransform, pointCloud } from './wire.js';

const STALLED_MS = 2000;
const SLOW_DRAW_MS = 250;
const BUSY_MS = 100;
const MOST_AGE_S = 60; // the clock of an older cloud is wrong, so its age is not shown

translate(document);
const page = {
  state: 'connecting',
  paused: false,
  quietMs: 0, // time since the last cloud
  clouds: 0, // since the last countSecond()
  points: 0,
  bytes: 0,
  age: null, // age of the last drawn cloud [s]
  received: {}, // counts by schema since the start
  spanS: 0.1,
  kept: null, // times [oldest, newest] of the slices that the page has kept [s]
  isLoading: false,
  robot: '',
  charts: new Charts(document.getElementById('charts')),
  scene: new Scene(document.getElementById('scene')),
  poses: new Poses(),
  recordedPoses: new Poses(), // poses of the replay
  links: new Links(),
  video: new Video(document.getElementById('video')),
};
const tools = buildTools(page);
page.slices = new Slices(
  {
    points: addSlice,
    picture: showPicture,
    span: (span) => {
      page.kept = span;
      setSpan();
    },
    arrived: (channel, header) => page.replay.arrived(channel, header),
    pose: ({ replay }, bytes) => {
      if (replay === page.replay.number) page.recordedPoses.add(frameTransform(bytes));
    },
  },
  () => page.connection,
);
page.replay = new Replay(
  {
    begin: (number) => {
      page.recordedPoses = new Poses();
      page.slices.replay(number);
    },
    end: () => page.slices.replay(0),
    show: (time) => page.slices.show(time, true),
    known: setSpan,
  },
  () => page.connection,
);
page.timeline = new Timeline(document.getElementById('timeline'), {
  jump,
  ask: (time) => (page.replay.isOn ? page.replay.show(time) : page.slices.show(time)),
  reach: () => (page.replay.isOn ? page.replay.reach : Infinity),
  last: () => (page.replay.isOn ? page.replay.last : page.timeline.span[1]),
  past: showTime,
  live: () => {
    page.slices.show(null);
    page.video.live();
    page.replay.end();
    page.choose();
    showTime();
  },
});

// --- clouds ---

let draco = null;
const waiting = new Map(); // clouds in the queue of the worker

function decodeDraco(cloud) {
  if (!draco) {
    draco = new Worker(new URL('draco_worker.js', document.baseURI));
    draco.onmessage = ({ data: { id, positions, intensities } }) => {
      const sent = waiting.get(id);
      waiting.delete(id);
      if (sent && positions) addCloud(sent, fromDraco(positions, intensities));
    };
  }
  if (waiting.size > 64) waiting.clear(); // the worker is too slow: skip its queue
  page.dracoId = (page.dracoId ?? 0) + 1;
  waiting.set(page.dracoId, { time: cloud.time, frame: cloud.frame });
  const data = cloud.data.slice().buffer;
  draco.postMessage({ id: page.dracoId, data }, [data]);
}

/**
 * Shows a cloud. `cloud.ageOf` exists only for slices, because the server reports when it sent
 * them.
 */
function addCloud(cloud, decoded) {
  page.quietMs = 0;
  ++page.clouds;
  page.points += decoded.points.length / 6;
  if (page.paused || page.timeline.isPast) return;
  show(cloud, decoded);
  const { time, ageOf } = cloud;
  page.newest = { time, ageOf: ageOf ?? ((captured) => nowSeconds() - captured) };
}

function show({ time, frame, place }, { points, has }) {
  tools.learn(points, has);
  const matrix = (page.replay.isOn ? page.recordedPoses : page.poses).at(frame, time);
  tools.hasPoses(matrix !== null);
  page.scene.add(points, time, matrix, place, !page.timeline.isPast);
}

const placed = (about, header) => ({ time: header.captured, frame: about.frameId, place: header });

function addSlice(about, header, decoded, clock) {
  const [scans, seconds] = about.framerate ?? [0, 1];
  if (scans > 0 && !page.paused) page.spanS = seconds / scans;
  page.quality = { step: decoded.step, error_bound: decoded.error };
  addCloud({ ...placed(about, header), ageOf: (captured) => clock.ageOf(captured) }, decoded);
}

// --- the past ---

function showPicture(picture) {
  if (!page.timeline.answered(picture, page.paused)) return;
  if (picture.jumped) page.scene.fresh.clear();
  if (page.replay.isOn) for (const { points } of picture.slices) page.points += points.length / 6;
  for (const { stream, header, ...decoded } of picture.slices) show(placed(page.slices.abouts[stream], header), decoded);
  page.scene.dirty = true;
}

/** Sets the range of the timeline to the recording, or to the slices that this page has kept. */
function setSpan() {
  const { replay, timeline } = page;
  const span = replay.span ?? (replay.isOn ? null : page.kept);
  if (span) timeline.span = span;
  if (replay.isOn && replay.isBroken) timeline.live();
  const words = replay.isBroken ? 'recording_broken' : replay.isDamaged ? 'recording_damaged' : '';
  timeline.tell(words && t(words));
}

function jump(time) {
  if (page.replay.span === null) return page.slices.show(time);
  const wasOn = page.replay.isOn;
  page.replay.begin(time);
  // A paused page is subscribed to slices only during a replay.
  if (!wasOn) page.choose();
}

/** Clears everything that belongs to the picture before. */
function showTime() {
  const { isPast } = page.timeline;
  if (isPast) page.scene.setCovariance(null);
  else page.scene.fresh.clear();
  page.age = null;
  document.body.dataset.time = isPast ? 'past' : 'live';
  setState(page.state);
}

page.forget = () => {
  page.kept = null;
  page.slices.forget();
  page.timeline.forget();
  page.replay.forget();
  page.scene.clear();
  page.video.clear();
};

function onStatistics(message) {
  page.statistics = message;
  const sink = Object.values(message.elements ?? {}).find((e) => e.factory === 'foxglovesink');
  if (sink?.scan_duration > 0 && !page.paused) page.spanS = sink.scan_duration * 1e-9;
  tools.setSpan();
  // Statistics describe the present, so the ellipse is not drawn for the past.
  if (message.pose_covariance && !page.timeline.isPast) page.scene.setCovariance(message.pose_covariance);
  const links = page.links.of(message, nowSeconds());
  page.charts.add({ ...page.quality, ...message, ...links, received: page.receivedBps, age: page.age });
}

const handlers = {
  'foxglove.PointCloud': (bytes) => {
    const cloud = pointCloud(bytes);
    addCloud(cloud, unpack(cloud));
  },
  'foxglove.CompressedPointCloud': (bytes) => decodeDraco(compressedCloud(bytes)),
  'foxglove.CompressedVideo': (bytes) => page.video.add(compressedVideo(bytes)),
  'foxglove.FrameTransform': (bytes) => page.poses.add(frameTransform(bytes)),
  'lidar.Slice': (bytes, channel, nanoseconds) => page.slices.add(channel, bytes, nanoseconds),
  'lidar.Statistics': (bytes) => onStatistics(JSON.parse(new TextDecoder().decode(bytes))),
};

// --- states ---

const TELLING = ['stalled', 'lost', 'refused', 'expired', 'foreign', 'limited', 'full'];

function setState(state) {
  page.state = state;
  document.body.dataset.state = state;
  document.body.toggleAttribute('data-paused', page.paused);
  const what = t(page.timeline.isPast ? (page.isLoading ? 'loading' : 'past') : state);
  document.querySelector('#state span').textContent = page.paused ? `${what}, ${t('paused')}` : what;
  const notice = document.getElementById('notice');
  notice.hidden = !TELLING.includes(state);
  notice.textContent = notice.hidden ? '' : t(`${state}_text`);
}
page.showState = () => setState(page.state);

function checkFlow() {
  if (page.state !== 'live' && page.state !== 'stalled') return;
  if (page.paused || page.replay.isOn) page.quietMs = 0;
  const quiet = page.quietMs > STALLED_MS;
  if (quiet !== (page.state === 'stalled')) setState(quiet ? 'stalled' : 'live');
}

/** Shows "loading" while slices up to the time to be shown are missing. */
function checkReplay() {
  const { replay, timeline } = page;
  const isLoading = replay.isOn && (replay.wanted !== null || timeline.at >= replay.reach);
  if (isLoading === page.isLoading) return;
  page.isLoading = isLoading;
  setState(page.state);
}

let counted = performance.now();
function countSecond() {
  const now = performance.now();
  const seconds = (now - counted) / 1000;
  counted = now;
  page.receivedBps = (page.bytes * 8) / seconds;
  const perSecond = Math.round(page.points / seconds);
  const live = page.state === 'live';
  const age = page.age === null ? [] : [`${number(page.age * 1000)} ms ${t('old')}`];
  if (page.timeline.isPast) age.push(new Date(page.timeline.at * 1000).toLocaleTimeString(language));
  const facts = [`${number(page.receivedBps * 1e-6, 1)} Mbit/s ${t('to_page')}`, `${number(perSecond)} pt/s`];
  document.getElementById('facts').textContent = live ? age.concat(facts).join(' · ') : '';
  page.bytes = page.points = page.clouds = 0;
}

// --- connection ---

function tokenOf() {
  const url = new URL(location.href);
  const given = url.searchParams.get('token');
  if (given === null) return sessionStorage.getItem('token') ?? '';
  // Removes the token from the address, where others could read it.
  sessionStorage.setItem('token', given);
  url.searchParams.delete('token');
  history.replaceState(null, '', url);
  return given;
}

function askForToken(state) {
  const dialog = document.getElementById('entry');
  const wrong = document.getElementById('wrong');
  const input = document.getElementById('token');
  wrong.hidden = !sessionStorage.getItem('token');
  wrong.textContent = t(`${state}_text`);
  input.setAttribute('aria-invalid', !wrong.hidden);
  if (!dialog.open) dialog.showModal();
  input.select();
  dialog.onclose = () => {
    sessionStorage.setItem('token', input.value);
    connect();
  };
}

function connect() {
  const on = {
    state: (state) => {
      if (state === 'open') page.quietMs = 0;
      if (state === 'lost') page.poses.end();
      // The connection is still lost, so the state stays as it is.
      if (state === 'connecting' && page.state !== 'connecting') return;
      setState(state === 'open' ? 'live' : state);
      if (state === 'refused' || state === 'expired') askForToken(state);
    },
    channels: (list) => tools.setRobots(robotsOf(list)),
    message: (channel, bytes, nanoseconds) => {
      page.bytes += bytes.length;
      const received = (page.received[channel.schemaName] ??= { messages: 0, bytes: 0 });
      ++received.messages;
      received.bytes += bytes.length;
      handlers[channel.schemaName](bytes, channel, nanoseconds);
    },
    subscribed: (channel) => page.replay.subscribed(channel),
    dropped: (channel) => {
      page.slices.close(channel);
      page.replay.dropped(channel);
    },
    recording: (channel, status) => page.replay.status(channel, status),
  };
  const wanted = (list) =>
    chooseChannels(list, {
      known: handlers,
      robot: page.robot,
      idle: document.hidden,
      paused: page.paused && !page.replay.isOn,
    });
  page.connection = new Connection(location.host, tokenOf(), on, wanted);
}

// If the page is hidden or paused, its subscriptions to clouds end.
page.choose = () => page.connection?.choose();
document.addEventListener('visibilitychange', () => {
  page.quietMs = 0;
  page.choose();
});

/** Reads the statistics of other pipelines, such as the sender's pipeline: ?also=robot:8765. */
function connectOthers() {
  for (const host of new URL(location.href).searchParams.getAll('also')) {
    const on = {
      state: () => {},
      message: (_, bytes) => onStatistics(JSON.parse(new TextDecoder().decode(bytes))),
    };
    new Connection(host, '', on, (list) => list.filter((c) => c.schemaName === 'lidar.Statistics'));
  }
}

// --- the loop ---

/**
 * Acknowledges the drawn slices, which lets the server send more, and notes the age of the drawn
 * cloud.
 */
function afterDrawing() {
  page.slices.drawn();
  page.replay.acknowledge();
  if (!page.newest) return;
  const age = page.newest.ageOf(page.newest.time);
  page.age = age >= 0 && age < MOST_AGE_S ? age : null;
  page.newest = null;
}

let drawn = 0;
let drawnCharts = 0;
function frame(now) {
  page.timeline.tick((now - drawn) / 1000, page.paused || page.replay.wanted !== null);
  page.scene.draw();
  const { time } = page.scene.fresh;
  if (!page.timeline.isPast) page.video.draw(time);
  else if (time !== null) page.video.replay(time);
  afterDrawing();
  // A busy browser may have received clouds that it has not yet passed to the page, so a long frame
  // counts as BUSY_MS at most.
  page.quietMs += Math.min(now - drawn, BUSY_MS);
  drawn = now;
  if (now - drawnCharts > SLOW_DRAW_MS) {
    drawnCharts = now;
    page.charts.draw(tools.style());
    page.timeline.update();
    checkFlow();
    checkReplay();
  }
  requestAnimationFrame(frame);
}

setState('connecting');
connect();
connectOthers();
setInterval(countSecond, 1000);
requestAnimationFrame(frame);
window.lidarPage = page; // for the browser's console, and for tests
