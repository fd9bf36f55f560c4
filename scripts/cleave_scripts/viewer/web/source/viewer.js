// One viewer: what it shows, and the controls that change it.
import {Bodies} from './bodies.js';
import {Graph} from './graph.js';
import {Pace} from './pace.js';
import {Plots} from './plots.js';
import {Stage} from './stage.js';

const COLOURINGS = ['part', 'island', 'residual', 'impulse'];
const UNITS = {
  residual: 'm/s',
  impulse: 'N s'
};

export class Viewer {
  constructor(section, recordings) {
    this.section = section;
    this.recordings = recordings;
    const find = (name) => section.querySelector(`[data-use="${name}"]`);
    this.ui = Object.fromEntries([
      'canvas', 'curves', 'mark', 'recording', 'combination', 'colour', 'speed', 'play', 'step', 'graph',
      'shadows', 'status', 'legend', 'note'
    ].map((name) => [name, find(name)]));
    this.stage = new Stage(this.ui.canvas, () => this.change());
    this.plots = new Plots(this.ui.curves, this.ui.mark, (step) => this.seekStep(step));
    this.ui.shadows.checked = !this.stage.software;
    this.pace = new Pace();
    this.frame = 0;
    this.framesDrawn = 0;
    this.playing = false;
    this.fill(this.ui.recording, recordings.map(({name}) => name));
    this.ui.recording.parentElement.hidden = recordings.length < 2;
    this.fill(this.ui.colour, COLOURINGS);
    this.listen();
  }

  async open(index) {
    this.section.dataset.state = 'loading';
    this.ui.recording.selectedIndex = index;
    this.pause();
    this.recording = await this.recordings[index].load();
    this.bodies?.dispose();
    this.graph?.dispose();
    this.bodies = new Bodies(this.recording);
    this.graph = new Graph(this.recording);
    this.stage.show(this.recording, this.bodies, this.graph);
    this.stage.setShadows(this.ui.shadows.checked);
    this.plots.show(this.recording);
    this.fill(this.ui.combination, this.recording.combinations);
    this.ui.step.max = this.recording.steps - 1;
    this.ui.note.textContent = this.recording.note +
        (this.stage.software ?
             'This browser draws without a graphics card: smooth edges and shadows are off, and while a run ' +
                 'plays its pictures have fewer pixels where 30 a second would not be reached.' :
             '');
    this.frame = this.recording.steps - 1;  // where there are parts and all bodies are in view
    this.painted = '';
    this.section.dataset.state = 'ready';
    this.resize();
  }

  fill(select, names) {
    select.replaceChildren(...names.map((name, i) => new Option(name, i)));
  }

  listen() {
    const {ui} = this;
    ui.recording.addEventListener('change', () => this.open(ui.recording.selectedIndex));
    ui.combination.addEventListener('change', () => this.repaint());
    ui.colour.addEventListener('change', () => this.repaint());
    ui.step.addEventListener('input', () => this.seek(Number(ui.step.value)));
    ui.play.addEventListener('click', () => this.toggle());
    ui.graph.addEventListener('change', () => this.change());
    ui.shadows.addEventListener('change', () => {
      this.stage.setShadows(ui.shadows.checked);
      this.change();
    });
    ui.canvas.addEventListener('click', (event) => this.tell(event));
    // From now on keys are meant for this viewer.
    ui.canvas.addEventListener('pointerdown', () => this.section.focus({preventScroll: true}));
    this.section.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(this.section);
  }

  key(event) {
    if (event.target.tagName === 'SELECT' || event.ctrlKey || event.altKey || event.metaKey) return;
    const stride = event.shiftKey ? 10 : 1, {ui} = this;
    const actions = {
      ' ': () => this.toggle(),
      ArrowRight: () => this.seek(this.frame + stride),
      ArrowLeft: () => this.seek(this.frame - stride),
      ArrowDown: () => this.choose(ui.combination, 1),
      ArrowUp: () => this.choose(ui.combination, -1),
      Home: () => this.seek(0),
      End: () => this.seek(this.recording.steps - 1),
      c: () => this.choose(ui.colour, 1),
      g: () => ui.graph.click(),
      r: () => {
        this.stage.following = true;
        this.repaint();
      },
    };
    if (!actions[event.key] || !this.recording) return;
    event.preventDefault();
    actions[event.key]();
  }

  choose(select, by) {
    select.selectedIndex = (select.selectedIndex + by + select.options.length) % select.options.length;
    this.repaint();
  }

  toggle() {
    if (this.playing) return this.pause();
    if (this.frame >= this.recording.steps - 1) this.seek(0);
    this.playing = true;
    this.clock = undefined;
    this.ui.play.textContent = 'Pause';
    this.change();
  }

  pause() {
    this.playing = false;
    this.ui.play.textContent = 'Play';
    this.pace.restart();
    if (this.stage.share === 1) return;
    this.stage.setShare(1);
    this.change();
  }

  seekStep(step) {
    const {step: steps} = this.recording;
    let frame = steps.findIndex((each) => each >= step);
    if (frame < 0) frame = steps.length - 1;
    this.seek(frame);
  }

  seek(frame) {
    this.pause();
    this.moveTo(frame);
  }

  moveTo(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.recording.steps - 1);
    this.moved = true;
    this.change();
  }

  repaint() {
    this.plots.redraw(this.combination);
    this.moved = true;
    this.change();
  }

  resize() {
    if (!this.recording || this.section.clientWidth === 0) return;
    this.stage.fit();
    this.repaint();
  }

  get combination() {
    return this.ui.combination.selectedIndex;
  }

  get colouring() {
    return COLOURINGS[this.ui.colour.selectedIndex];
  }

  // Draws with the next refresh of the screen; any number of changes until then are one picture.
  change() {
    if (this.waiting || !this.recording) return;
    this.waiting = true;
    requestAnimationFrame((time) => {
      this.waiting = false;
      this.advance(time);
      this.draw();
      if (this.playing) this.change();
    });
  }

  // Playback follows the clock, not the number of pictures: a slow machine leaves steps out.
  advance(time_ms) {
    if (!this.playing) return;
    if (this.stage.software) {
      this.pace.note(time_ms);
      this.stage.setShare(this.pace.share);
    }
    if (this.clock === undefined) this.clock = {time_ms, from: this.recording.step[this.frame]};
    const passed = (time_ms - this.clock.time_ms) / 1000 * Number(this.ui.speed.value);
    const step = this.clock.from + passed / this.recording.h_s;
    while (this.frame < this.recording.steps - 1 && this.recording.step[this.frame + 1] <= step) {
      ++this.frame;
      this.moved = true;
    }
    if (this.frame >= this.recording.steps - 1) this.pause();
  }

  draw() {
    if (this.moved) {
      this.moved = false;
      this.measured = this.recording.measuredAt(this.frame);
      this.bodies.place(this.frame);
      this.stage.follow();
      this.paint();
      this.graph.place(this.frame, this.measured, this.combination);
      this.plots.mark(this.recording.step[this.frame]);
      this.ui.step.value = this.frame;
      this.ui.status.textContent = this.statusText();
      this.drawLegend();
    }
    this.stage.draw(this.ui.graph.checked);
    ++this.framesDrawn;
  }

  // Only what changed: most steps have the colours of the one before.
  paint() {
    const colours = `${this.colouring} ${this.measured} ${this.combination}`;
    if (colours !== this.painted) this.bodies.paint(this.colouring, this.measured, this.combination);
    this.painted = colours;
  }

  statusText() {
    const {recording, measured, combination} = this, step = recording.step[this.frame];
    const time = `step ${step} of ${recording.planned_steps}, ${(step * recording.h_s).toFixed(2)} s`;
    if (measured < 0) return `${time} \u2014 not measured yet`;
    const at = recording.curveIndex(measured, combination), of = recording.measuredStep[measured];
    const parts = new Set();
    for (let body = 0; body < recording.bodies; ++body)
      parts.add(recording.ofBody(recording.part, measured, combination, body));
    const split = parts.has(recording.no_part) ?
        'no parts' :
        `${parts.size} parts, ${this.graph.cutPairs} of ${
            recording.firstEdge[measured + 1] - recording.firstEdge[measured]} edges cut, ` +
            `${recording.interfaceRows[at]} interface rows`;
    const solved = recording.ok[at] ? '' : ' \u2014 NOT SOLVED';
    return `${time} \u2014 graph${of === step ? '' : ` of step ${of}`}: ${split}, ` +
        `t_s ${Number(recording.tSMs[at].toPrecision(3))} ms${solved}`;
  }

  drawLegend() {
    const {colouring, recording} = this, range = recording.ranges[colouring];
    if (!range) {
      this.ui.legend.textContent = colouring === 'part' ?
          'a colour a part; parts that share constraints differ' :
          'a colour an island; near ones differ';
      return;
    }
    if (this.ui.legend.dataset.of === colouring && this.ui.legend.firstChild?.tagName === 'I') return;
    const bar = document.createElement('i');
    bar.style.background = `linear-gradient(to right, ${recording.ramp_css.join(',')})`;
    this.ui.legend.replaceChildren(
        bar,
        ` ${range.least.toExponential(0)} \u2026 ${range.most.toExponential(0)} ` +
            `${UNITS[colouring]}, logarithmic`);
    this.ui.legend.dataset.of = colouring;
  }

  // What is known about the body that was clicked.
  tell(event) {
    const body = this.bodies.pick(this.stage.rayAt(event.offsetX, event.offsetY));
    if (body < 0 || this.measured < 0) return;
    const {recording, measured, combination} = this;
    const value = (name) => recording.magnitude(
        recording.ranges[name], recording.ofBody(recording[name], measured, combination, body));
    this.ui.status.textContent = `body ${body}: ${Number(recording.mass_kg[body].toPrecision(4))} kg, part ` +
        `${recording.ofBody(recording.part, measured, combination, body)}, island ` +
        `${recording.island[measured * recording.bodies + body]}, residual ${
                                     value('residual').toExponential(1)} m/s, ` +
        `largest impulse ${value('impulse').toExponential(1)} N s`;
  }
}
