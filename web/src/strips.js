// σ_th, inliers, iterations and time over the sweeps.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { colour, onTheme } from './theme.js';

const STRIPS = [
  { name: 'σ_th', unit: 'm', of: (r) => r.sigmaTh, digits: 3, stroke: 'estimate' },
  { name: 'inliers', unit: '', of: (r) => r.inliers, digits: 0, stroke: 'good' },
  { name: 'iterations', unit: '', of: (r) => r.iterations, digits: 0, stroke: 'coarse' },
  { name: 'time per sweep', unit: 'ms', of: (r) => r.ms[0], digits: 1, stroke: 'warn' },
];
const PAD = { left: 44, right: 8 };

const short = (value) => (Math.abs(value) >= 1000 ? `${+(value / 1000).toFixed(1)}k` : `${+value.toPrecision(3)}`);

class Strip {
  constructor(parent, spec, seek) {
    this.spec = spec;
    this.element = document.createElement('section');
    this.element.className = 'strip';
    this.element.innerHTML = '<h2><span></span><b>–</b></h2><div class="plot"><div class="now"></div></div>';
    this.element.querySelector('span').textContent = spec.name + (spec.unit ? ` (${spec.unit})` : '');
    this.value = this.element.querySelector('b');
    this.box = this.element.querySelector('.plot');
    this.now = this.element.querySelector('.now');
    this.data = [[], []];
    parent.append(this.element);
    this.box.addEventListener('click', (event) => {
      const { left } = this.box.getBoundingClientRect();
      const share = (event.clientX - left - PAD.left) / (this.box.clientWidth - PAD.left - PAD.right);
      seek(Math.round(Math.max(0, Math.min(1, share)) * (this.data[0].length - 1)));
    });
  }

  /// Anew: a canvas does not change its colours by itself.
  draw() {
    this.plot?.destroy();
    const grid = { stroke: colour('line'), width: 1 };
    const axis = { stroke: colour('muted'), font: '11px system-ui', ticks: { show: false }, grid };
    this.plot = new uPlot({
      width: this.box.clientWidth || 300,
      height: 72,
      legend: { show: false },
      cursor: { show: false },
      padding: [4, PAD.right, 0, 0],
      scales: { x: { time: false, range: () => [0, Math.max(1, this.data[0].length - 1)] },
        y: { range: (_, low, high) => [0, high > 0 ? high * 1.12 : 1] } },
      axes: [{ ...axis, size: 18, gap: 2, space: 60 }, { ...axis, size: PAD.left, gap: 4, space: 20, values: (_, ticks) => ticks.map(short) }],
      series: [{}, { stroke: colour(this.spec.stroke), width: 1.4, points: { show: false } }],
    }, this.data, this.box);
  }

  add(records, first) {
    for (let i = first; i < records.length; ++i) {
      this.data[0].push(i);
      this.data[1].push(this.spec.of(records[i]));
    }
  }

  show(number, record) {
    const value = this.spec.of(record);
    this.value.textContent = `${value.toFixed(this.spec.digits)}${this.spec.unit ? ` ${this.spec.unit}` : ''}`;
    const width = this.box.clientWidth - PAD.left - PAD.right;
    this.now.style.left = `${PAD.left + (width * number) / Math.max(1, this.data[0].length - 1) - 1}px`;
  }
}

export class Strips {
  constructor(parent, seek) {
    this.strips = STRIPS.map((spec) => new Strip(parent, spec, seek));
    onTheme(() => this.strips.forEach((strip) => strip.draw()));
    new ResizeObserver(() => this.strips.forEach((strip) => {
      strip.plot.setSize({ width: strip.box.clientWidth || 300, height: 72 });
    })).observe(parent);
  }

  clear() {
    for (const strip of this.strips) {
      strip.data = [[], []];
      strip.value.textContent = '–';
      this.stale = true;
    }
  }

  add(records, first) {
    this.strips.forEach((strip) => strip.add(records, first));
    this.stale = true;
  }

  show(number, record) {
    this.strips.forEach((strip) => strip.show(number, record));
  }

  /// Ten times a second at most: drawing them costs more than a sweep does.
  refresh(now) {
    if (!this.stale || now - (this.drawn ?? -1e9) < 100) return;
    this.strips.forEach((strip) => strip.plot.setData(strip.data));
    this.drawn = now;
    this.stale = false;
  }
}
