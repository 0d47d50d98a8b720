// Puts the parts together.
import './style.css';
import { Ellipsoids } from './ellipsoids.js';
import { listen } from './keys.js';
import { MapLayer } from './map_layer.js';
import { Panel } from './panel.js';
import { PathLayer } from './path_layer.js';
import { Rate } from './rate.js';
import { Run } from './run.js';
import { Stage } from './scene.js';
import { Socket } from './socket.js';
import { Strips } from './strips.js';
import { SweepLayer } from './sweep_layer.js';
import { toggleTheme } from './theme.js';
import { Timeline } from './timeline.js';

const $ = (id) => document.getElementById(id);

class View {
  constructor() {
    this.run = new Run((message) => this.socket?.send(message));
    this.stage = new Stage($('scene'));
    this.map = new MapLayer(this.stage);
    this.sweep = new SweepLayer(this.stage);
    this.paths = new PathLayer(this.stage);
    this.ellipsoids = new Ellipsoids(this.stage);
    this.panel = new Panel(this.sweep);
    this.strips = new Strips($('strips'), (number) => this.run.show(number));
    this.timeline = new Timeline(this.run);
    this.rate = new Rate($('rate'), $('detail'));
    this.hear();
    this.controls();
    listen(this);
    this.socket = new Socket((frame) => this.run.take(frame), (state, why) => this.connection(state, why));
    requestAnimationFrame((now) => this.frame(now));
  }

  hear() {
    const on = (type, listener) => this.run.addEventListener(type, ({ detail }) => listener(detail));
    on('reset', () => [this.map, this.sweep, this.paths, this.strips].forEach((part) => part.clear()));
    on('info', () => this.panel.info(this.run.info));
    on('map', (frame) => this.map.add(frame, this.run.records));
    on('records', (first) => {
      this.paths.add(this.run.records, first, this.run.info.initial_pose.indexOf('coarse'));
      this.strips.add(this.run.records, first);
      this.timeline.stale = true;
    });
    on('sweep', (frame) => {
      this.sweep.take(frame, this.run.records[frame.number]);
      this.sweep.points.visible = this.layer('sweep').checked;
      this.panel.legend();
      this.offer();
    });
    on('shown', () => { this.moved = true; });
    on('mode', () => this.mode());
    on('progress', () => this.mode());
  }

  /// Colours that this sweep has no data for are not offered.
  offer() {
    for (const option of $('colour').options) option.disabled = !this.sweep.has(option.value);
  }

  layer(name) {
    return document.querySelector(`[data-layer=${name}]`);
  }

  controls() {
    const { run } = this;
    $('first').onclick = () => run.show(0);
    $('back').onclick = () => { run.play(false); run.show(run.shown - 1); };
    $('next').onclick = () => { run.play(false); run.show(run.shown + 1); };
    $('last').onclick = () => run.show(Infinity, true);
    $('play').onclick = () => run.play(!this.moving);
    $('theme').onclick = () => this.theme();
    $('help').onclick = () => $('keys').showModal();
    $('colour').onchange = () => { this.sweep.setMode($('colour').value); this.panel.legend(); };
    $('camera').onchange = () => this.stage.setMode($('camera').value);
    for (const box of document.querySelectorAll('[data-layer]')) box.onchange = () => this.layers();
    addEventListener('pointerdown', (event) => {
      if (!event.target.closest('#layers')) $('layers').open = false;
    });
  }

  /// Playing, or staying at the newest sweep of a live run.
  get moving() {
    return this.run.playing || (this.run.newest && !this.run.progress.finished);
  }

  layers() {
    const on = (name) => this.layer(name).checked;
    this.map.group.visible = on('map');
    this.sweep.points.visible = on('sweep') && this.sweep.frame !== null;
    this.paths.estimate.wanted = on('path');
    this.paths.truth.wanted = on('truth');
    this.paths.marksWanted = on('choice');
    this.ellipsoids.covariance.wanted = on('covariance');
    this.ellipsoids.evidence.wanted = on('evidence');
    this.stage.rings.visible = on('rings');
    this.moved = true;
  }

  toggle(name) {
    this.layer(name).checked = !this.layer(name).checked;
    this.layers();
  }

  choose(id, value) {
    if ([...$(id).options].find((option) => option.value === value)?.disabled) return;
    $(id).value = value;
    $(id).onchange();
  }

  speed(by) {
    const next = Math.max(0, Math.min($('speed').options.length - 1, $('speed').selectedIndex + by));
    $('speed').selectedIndex = next;
  }

  theme() {
    toggleTheme();
    this.panel.legend();
  }

  mode() {
    $('play').textContent = this.moving ? '❚❚' : '▶';
    $('play').setAttribute('aria-label', this.moving ? 'Pause' : 'Play');
    $('last').setAttribute('aria-pressed', String(this.run.newest));
    this.tell();
  }

  connection(state, why) {
    this.state = why ?? state;
    if (state === 'open') this.run.reset();
    this.tell();
  }

  tell() {
    const { progress, info } = this.run;
    const element = $('connection');
    const open = this.state === 'open';
    element.className = open ? (progress.finished ? '' : 'live') : 'lost';
    const kind = info?.live ? 'live' : 'reading';
    const text = open ? (progress.finished ? (info?.live ? 'run finished' : 'replay') : `● ${kind}`) : 'connection lost; trying again';
    const dropped = progress.dropped > 0 && info?.live ? `, points of ${progress.dropped} sweeps dropped` : '';
    const full = text + dropped;
    if (element.textContent !== full) element.textContent = full;
  }

  update() {
    const { run } = this;
    if (!this.moved || run.shown < 0) return;
    this.moved = false;
    const record = run.records[run.shown];
    const jump = Math.abs(run.shown - (this.placed ?? -100)) > 3;
    this.placed = run.shown;
    this.stage.place(record, jump);
    this.map.show(run.shown);
    this.paths.show(run.shown);
    this.ellipsoids.show(record);
    this.panel.show(run);
    this.strips.show(run.shown, record);
    this.timeline.show(run.shown);
  }

  frame(now) {
    requestAnimationFrame((next) => this.frame(next));
    const elapsed = Math.min(0.25, (now - (this.last ?? now)) / 1000);
    this.last = now;
    this.run.advance(elapsed * Number($('speed').value));
    this.update();
    this.strips.refresh(now);
    this.timeline.refresh(now);
    if (!this.stage.dirty) return this.rate.rest();
    this.map.share = this.rate.share;
    const ratio = this.stage.renderer.getPixelRatio();
    const drawn = this.map.prepare(this.stage.pixelScale, ratio) + this.sweep.prepare(this.stage.pixelScale, ratio);
    this.stage.render();
    this.rate.drew(now, drawn, this.map.count);
  }
}

// For the developer tools.
globalThis.viewer = new View();
