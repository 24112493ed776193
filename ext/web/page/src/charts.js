// SPDX-License-Identifier: LGPL-2.1-or-later
// Charts of the last minute. A chart is shown as soon as one of its numbers has arrived.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { MOST_LINKS } from './links.js';
import { number, t } from './text.js';

const KEPT_S = 60;
const MBIT = 1e-6;
const KB = 1e-3;
// Quiet lines extend the axis to at most this multiple of the maximum of the other lines.
const QUIET_SHARE = 2.5;
const LINKS = Array.from({ length: MOST_LINKS }, (_, i) => i);

const ofLinks = (title, unit, what, scale = 1) => ({
  title,
  unit,
  series: LINKS.map((i) => ({ key: `link_${i}_${what}`, link: `link_${i}`, label: 'link', scale })),
});

/**
 * The keys are members of lidar.Statistics, or the page adds them (`received`, `age`, `link_0`).
 */
const CHARTS = [
  {
    title: 'Age of the cloud',
    unit: 'ms',
    series: [{ key: 'age', label: 'drawn', scale: 1000 }],
  },
  {
    title: 'Bitrate',
    unit: 'Mbit/s',
    series: [
      { key: 'estimated_capacity', label: 'capacity', scale: MBIT, quiet: true },
      { key: 'target_bitrate', label: 'target', scale: MBIT },
      { key: 'sent_bitrate', label: 'sent', scale: MBIT },
    ],
  },
  {
    title: 'Delay',
    unit: 'ms',
    series: [
      { key: 'rtt', label: 'round trip', quiet: true },
      { key: 'queue_delay', label: 'queue' },
    ],
  },
  {
    title: 'Window',
    unit: 'kB',
    series: [
      { key: 'ref_wnd', label: 'allowed in flight', scale: KB, quiet: true },
      { key: 'bytes_in_flight', label: 'in flight', scale: KB },
    ],
  },
  {
    title: 'Precision',
    unit: 'mm',
    series: [
      { key: 'step', label: 'step', scale: 1000 },
      { key: 'error_bound', label: 'largest error', scale: 1000, quiet: true },
    ],
  },
  {
    title: 'Losses',
    unit: 'since the start',
    whole: true,
    series: [
      { key: 'packets_lost', label: 'packets lost' },
      { key: 'packets_ce', label: 'marked', quiet: true },
      { key: 'slices_lost', label: 'slices lost' },
    ],
  },
  {
    title: 'Deviation of the pose',
    unit: 'm',
    series: [{ key: 'position_deviation', label: 'position' }],
  },
  {
    title: 'Poses',
    unit: 'since the start',
    whole: true,
    series: [
      { key: 'poses_lost', label: 'poses lost' },
      { key: 'poses_degenerate', label: 'degenerate', quiet: true },
    ],
  },
  {
    title: 'To this page',
    unit: 'Mbit/s',
    series: [{ key: 'received', label: 'received', scale: MBIT }],
  },
  ofLinks('Links', 'Mbit/s', 'bitrate', MBIT),
  ofLinks('Round trip of links', 'ms', 'rtt'),
  ofLinks('Queue of links', 'ms', 'queue'),
];

const show = (value, whole) => {
  if (value === null || value === undefined) return '–';
  if (whole || value >= 100) return number(value);
  return number(value, value >= 10 ? 1 : 2);
};

class Chart {
  constructor(config, parent) {
    this.config = config;
    this.data = [[], ...config.series.map(() => [])];
    this.element = document.createElement('section');
    this.element.className = 'chart';
    this.element.hidden = true;
    this.element.innerHTML = `<h2>${t(config.title)}<span>${t(config.unit)}</span></h2>
      <dl></dl><div class="plot" role="img"></div>`;
    this.list = this.element.querySelector('dl');
    this.values = config.series.map((series, i) => {
      const item = document.createElement('div');
      item.innerHTML = `<dt><i data-line="${i}"${series.quiet ? ' data-quiet' : ''}></i><span></span></dt><dd>–</dd>`;
      item.querySelector('span').textContent = t(series.label);
      this.list.append(item);
      return item;
    });
    this.plotElement = this.element.querySelector('.plot');
    parent.append(this.element);
  }

  /** Adds a number to each series, or null if `message` does not have it. */
  add(time, message) {
    const numbers = this.config.series.map(({ key, scale = 1 }) =>
      typeof message[key] === 'number' ? message[key] * scale : null,
    );
    if (this.element.hidden && numbers.every((n) => n === null)) return;
    this.element.hidden = false;
    this.data[0].push(time);
    numbers.forEach((n, i) => this.data[i + 1].push(n));
    while (this.data[0][0] < time - KEPT_S) this.data.forEach((column) => column.shift());
    this.values.forEach((item, i) => {
      item.hidden = this.data[i + 1].every((n) => n === null);
      item.querySelector('dd').textContent = show(numbers[i], this.config.whole);
      const link = message[this.config.series[i].link];
      if (link) item.querySelector('span').textContent = link.state ? `${link.name} (${t(link.state)})` : link.name;
    });
    this.plotElement.setAttribute(
      'aria-label',
      `${t(this.config.title)}: ` +
        this.config.series.map((s, i) => `${t(s.label)} ${show(numbers[i])}`).join(', '),
    );
  }

  draw(style, now) {
    if (this.element.hidden || this.plotElement.clientWidth === 0) return;
    if (!this.plot || this.style !== style) this.make(style);
    if (this.plot.width !== this.plotElement.clientWidth)
      this.plot.setSize({ width: this.plotElement.clientWidth, height: this.plot.height });
    this.now = now;
    this.plot.setData(this.data);
  }

  /**
   * Returns the upper end of the axis. Quiet lines extend it to at most QUIET_SHARE times the
   * maximum of the other lines.
   */
  top() {
    const most = (quiet) =>
      this.config.series.reduce((all, series, i) => {
        if (!!series.quiet !== quiet) return all;
        return this.data[i + 1].reduce((m, v) => Math.max(m, v ?? 0), all);
      }, 0);
    const loud = most(false);
    const top = loud > 0 ? Math.max(loud, Math.min(most(true), QUIET_SHARE * loud)) : most(true);
    return top > 0 ? top * 1.15 : 1;
  }

  make(style) {
    this.plot?.destroy();
    this.style = style;
    const axis = {
      stroke: style.muted,
      font: '11px system-ui, sans-serif',
      ticks: { show: false },
      grid: { stroke: style.line, width: 1 },
    };
    const lines = this.config.series.map((series, i) => ({
      label: series.label,
      stroke: style.series[i],
      width: series.quiet ? 1.25 : 2,
      dash: series.quiet ? [3, 3] : undefined,
      points: { show: false },
      spanGaps: true,
    }));
    this.plot = new uPlot(
      {
        width: this.plotElement.clientWidth,
        height: 108,
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 4, 8, 0],
        scales: {
          x: { time: false, range: () => [this.now - KEPT_S, this.now] },
          y: { range: () => [0, this.top()] },
        },
        axes: [
          {
            ...axis,
            size: 18,
            gap: 2,
            splits: () => [this.now - KEPT_S + 4, this.now - KEPT_S / 2, this.now - 1],
            values: () => [`−${KEPT_S} s`, `−${KEPT_S / 2} s`, '0'],
          },
          { ...axis, size: 42, space: 26, gap: 4, values: (_, v) => v.map((n) => number(n, n % 1 ? 1 : 0)) },
        ],
        series: [{}, ...lines],
      },
      this.data,
      this.plotElement,
    );
  }
}

export class Charts {
  constructor(parent) {
    this.charts = CHARTS.map((config) => new Chart(config, parent));
    this.samples = 0;
  }

  /** Adds the numbers of `message`, a lidar.Statistics. */
  add(message) {
    const time = performance.now() / 1000;
    ++this.samples;
    for (const chart of this.charts) chart.add(time, message);
  }

  draw(style) {
    const now = performance.now() / 1000;
    for (const chart of this.charts) chart.draw(style, now);
  }
}
