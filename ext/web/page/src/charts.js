// SPDX-License-Identifier: LGPL-2.1-or-later
// Charts of the last minute: a chart a question, shown where its numbers exist.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';

const KEPT_S = 60;
const MBIT = 1e-6;
const KB = 1e-3;

/** Members of lidar.Statistics, and what the page measures itself (`received`). */
const CHARTS = [
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
      { key: 'ref_wnd', label: 'ref_wnd', scale: KB, quiet: true },
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
    title: 'To this page',
    unit: 'Mbit/s',
    series: [{ key: 'received', label: 'received', scale: MBIT }],
  },
];

const show = (value, whole) => {
  if (value === null || value === undefined) return '–';
  if (whole || value >= 100) return Math.round(value).toLocaleString('en');
  return value >= 10 ? value.toFixed(1) : value.toFixed(2);
};

class Chart {
  constructor(config, parent) {
    this.config = config;
    this.data = [[], ...config.series.map(() => [])];
    this.element = document.createElement('section');
    this.element.className = 'chart';
    this.element.hidden = true;
    this.element.innerHTML = `<h2>${config.title}<span>${config.unit}</span></h2>
      <dl></dl><div class="plot" role="img"></div>`;
    this.list = this.element.querySelector('dl');
    this.values = config.series.map((series, i) => {
      const item = document.createElement('div');
      item.innerHTML = `<dt><i data-line="${i}"${series.quiet ? ' data-quiet' : ''}></i>${series.label}</dt><dd>–</dd>`;
      this.list.append(item);
      return item;
    });
    this.plotElement = this.element.querySelector('.plot');
    parent.append(this.element);
  }

  /** One number a series; null where it is not known. */
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
    });
    this.plotElement.setAttribute(
      'aria-label',
      `${this.config.title}: ` +
        this.config.series.map((s, i) => `${s.label} ${show(numbers[i])}`).join(', '),
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
        height: 92,
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 4, 8, 0],
        scales: {
          x: { time: false, range: () => [this.now - KEPT_S, this.now] },
          y: { range: (_, low, high) => [0, high > 0 ? high * 1.15 : 1] },
        },
        axes: [
          { ...axis, show: false },
          { ...axis, size: 38, space: 26, gap: 4, values: (_, v) => v.map((n) => n.toLocaleString('en')) },
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

  /** `message` is a lidar.Statistics. */
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
