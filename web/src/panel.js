// The figures of the shown sweep, in words and numbers.
import { EXAGGERATION } from './ellipsoids.js';
import { table } from './colours.js';
import { isLight, onTheme } from './theme.js';

const $ = (id) => document.getElementById(id);

const REASONS = {
  first_sweep: 'nothing to predict from',
  coarse_disabled: 'the coarse stage is off',
  coarse_not_needed: 'the prediction explains the map; the coarse stage was not run',
  within_tau: 'coarse result within τ of the prediction',
  beyond_tau: 'coarse result beyond τ of the prediction',
  better_map_score: 'coarse result explains the map better',
  worse_map_score: 'coarse result explains the map worse',
  no_time: 'no time for the coarse stage',
};
const GRAVITY = { ok: 'ok', initialising: 'ok', recovered: 'warn', degenerate: 'warn', lost: 'bad', empty: 'bad' };
const DECADES = 4; // shown of the eigenvalues

const words = (name) => name.replaceAll('_', ' ');
const mm = (variance) => (Math.sqrt(Math.max(0, variance)) * 1000).toFixed(1);
const mrad = (sigma) => (sigma * 1000).toFixed(2);

export class Panel {
  constructor(sweepLayer) {
    this.sweepLayer = sweepLayer;
    $('exaggeration').textContent = `${EXAGGERATION} times`;
    const bars = Array.from({ length: 6 }, () => document.createElement('i'));
    this.limit = document.createElement('i');
    this.limit.className = 'limit';
    this.bars = bars;
    $('bars').append(...bars, this.limit);
    onTheme(() => this.legend());
  }

  info(info) {
    $('title').textContent = info.title;
    document.title = `${info.title} – Rilo viewer`;
    const ratio = info.degenerate_ratio;
    $('ratio').textContent = ratio > 0 ? `dashed: ${ratio}, below it a direction counts as not seen` : '';
    this.limit.style.bottom = `${this.height(ratio)}%`;
    this.limit.hidden = !(ratio > 0);
    $('message').hidden = !info.note;
    $('message').textContent = info.note;
    if (info.note) setTimeout(() => { $('message').hidden = true; }, 8000);
  }

  height(eigenvalue) {
    return eigenvalue > 0 ? Math.max(0, 100 * (1 + Math.log10(eigenvalue) / DECADES)) : 0;
  }

  show(run) {
    const { info, shown } = run;
    const record = run.records[shown];
    const status = info.status[record.status] ?? '?';
    $('fact-sweep').textContent = `${shown + 1} of ${Math.max(run.records.length, run.progress.total)}`;
    $('fact-status').textContent = words(status);
    $('fact-status').className = GRAVITY[status] ?? '';
    $('fact-speed').textContent = `${record.speed.toFixed(1)} m/s, ${((record.turn * 180) / Math.PI).toFixed(0)}°/s`;
    $('fact-path').textContent = `${run.metres[shown].toFixed(0)} m`;
    const off = record.hasTruth ? Math.hypot(...record.position.map((p, i) => p - record.truth[i])) : null;
    $('fact-truth').textContent = off === null ? 'no truth' : `${off.toFixed(2)} m`;
    $('key').querySelector('.truth').style.display = off === null ? 'none' : '';
    $('choice').textContent = words(info.initial_pose[record.source] ?? '?');
    $('choice').style.color = info.initial_pose[record.source] === 'coarse' ? 'var(--coarse)' : '';
    const reason = REASONS[info.initial_pose_reason[record.reason]] ?? '';
    $('reason').textContent = reason + (record.coarseRan ? `; ${record.coarseIterations} iterations` : '');
    this.certainty(record, info.degenerate_ratio);
    $('clock').textContent = `${run.seconds[shown].toFixed(1)} of ${run.seconds.at(-1).toFixed(1)} s`;
  }

  certainty(record, ratio) {
    record.eigenvalues.forEach((value, i) => {
      this.bars[i].style.height = `${this.height(value)}%`;
      this.bars[i].className = value < ratio ? 'weak' : '';
    });
    $('bars').setAttribute('aria-label', `Relative eigenvalues: ${record.eigenvalues.map((v) => v.toPrecision(2)).join(', ')}`);
    const c = record.covariance;
    $('sigmas').textContent = `1σ  x ${mm(c[0])}  y ${mm(c[3])}  z ${mm(c[5])} mm\n`
      + `     roll ${mrad(record.sigmaRotation[0])}  pitch ${mrad(record.sigmaRotation[1])}  yaw ${mrad(record.sigmaRotation[2])} mrad`;
  }

  legend() {
    const [low, high] = this.sweepLayer.span;
    $('legend-low').textContent = low;
    $('legend-high').textContent = high;
    const bar = $('legend-bar');
    bar.hidden = high === '';
    const name = this.sweepLayer.mode === 'residual' ? 'residual' : 'scale';
    const colours = table(isLight() ? `${name}Light` : name);
    const context = bar.getContext('2d');
    for (let x = 0; x < bar.width; ++x) {
      const k = 4 * Math.floor((x / bar.width) * 256);
      context.fillStyle = `rgb(${colours[k]} ${colours[k + 1]} ${colours[k + 2]})`;
      context.fillRect(x, 0, 1, bar.height);
    }
  }
}
