// Curves of all combinations over the steps, the chosen one strong, with a mark at the step in view.

const LEFT = 64, RIGHT = 12, TOP = 18, GAP = 30, BOTTOM = 22;
const CHOSEN = '#0b57b7', OTHERS = 'rgba(110,120,135,0.28)', FAILED = '#d02020', TEXT = '#39424e';

export class Plots {
  // marker: an element that is moved over the canvas, which is cheaper than to draw the curves again.
  constructor(canvas, marker, onSeek) {
    this.canvas = canvas;
    this.marker = marker;
    let seeking = false;
    const seek = (event) => onSeek(this.stepAt(event.offsetX));
    canvas.addEventListener('pointerdown', (event) => {
      seeking = true;
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', (event) => seeking && seek(event));
    canvas.addEventListener('pointerup', () => {
      seeking = false;
    });
  }

  show(recording) {
    this.recording = recording;
    this.lastStep = Math.max(1, recording.step[recording.steps - 1]);
  }

  // Draws the curves, which change only with the combination and the size.
  redraw(combination) {
    const scale = window.devicePixelRatio, {clientWidth: width, clientHeight: height} = this.canvas;
    Object.assign(this.canvas, {width: Math.round(width * scale), height: Math.round(height * scale)});
    const context = this.canvas.getContext('2d');
    context.scale(scale, scale);
    context.font = '11px system-ui, sans-serif';
    const inner = (height - TOP - GAP - BOTTOM) / 2;
    const {tSMs, interfaceRows} = this.recording;
    // Times of slow combinations and steps are a hundred times those of the others.
    const times = {label: 't_s, ms, logarithmic', values: tSMs, scale: logarithmic(tSMs), top: TOP};
    const rows = {
      label: 'interface rows',
      values: interfaceRows,
      scale: linear(interfaceRows),
      top: TOP + inner + GAP
    };
    for (const curves of [times, rows]) this.drawOne(context, {...curves, height: inner, width, combination});
    this.drawSteps(context, width, height);
  }

  mark(step) {
    this.marker.style.transform = `translateX(${this.x(step)}px)`;
  }

  x(step) {
    return LEFT + (this.canvas.clientWidth - LEFT - RIGHT) * step / this.lastStep;
  }

  stepAt(x) {
    return Math.round((x - LEFT) / (this.canvas.clientWidth - LEFT - RIGHT) * this.lastStep);
  }

  drawOne(context, {label, values, scale, top, height, width, combination}) {
    const count = this.recording.combinationCount;
    const y = (value) => top + height * (1 - scale.place(value));
    context.fillStyle = TEXT;
    context.textAlign = 'left';
    context.fillText(label, LEFT, top - 6);
    context.textAlign = 'right';
    context.strokeStyle = '#e2e6ec';
    context.lineWidth = 1;
    for (const value of scale.ticks) {
      context.fillText(String(Number(value.toPrecision(6))), LEFT - 6, y(value) + 4);
      line(context, [[LEFT, y(value)], [width - RIGHT, y(value)]]);
    }
    const points = (c) => [...this.recording.curveStep]
                              .map((step, k) => [this.x(step), values[k * count + c]])
                              .filter(([, value]) => value >= scale.ticks[0])
                              .map(([x, value]) => [x, y(value)]);
    context.strokeStyle = OTHERS;
    for (let c = 0; c < count; ++c)
      if (c !== combination) line(context, points(c));
    context.strokeStyle = CHOSEN;
    context.lineWidth = 1.8;
    line(context, points(combination));
    this.drawFailures(context, combination, top + height);
  }

  // A cross on the axis for every step that the chosen combination did not solve.
  drawFailures(context, combination, bottom) {
    const {curveStep, ok, combinationCount} = this.recording;
    context.fillStyle = FAILED;
    context.textAlign = 'center';
    curveStep.forEach((step, k) => {
      if (!ok[k * combinationCount + combination]) context.fillText('\u00d7', this.x(step), bottom + 3);
    });
  }

  drawSteps(context, width, height) {
    const tick = niceTick(this.lastStep);
    context.fillStyle = TEXT;
    context.textAlign = 'center';
    for (let step = 0; step <= this.lastStep; step += tick)
      context.fillText(step === 0 ? 'step 0' : String(step), this.x(step), height - 6);
  }
}

function line(context, points) {
  context.beginPath();
  if (points.length === 1) points.push([points[0][0] + 2, points[0][1]]);
  points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
}

// Scales: where values stand between 0 and 1, and the values that are written beside the axis, the least
// first.

function linear(values) {
  let most = 0;
  for (const value of values)
    if (value > most) most = value;
  const tick = niceTick(most), count = Math.max(1, Math.ceil(most / tick));
  return {
    place: (value) => value / (count * tick),
    ticks: Array.from({length: count + 1}, (_, i) => i * tick),
  };
}

// Whole powers of ten; values that are not positive have no place.
function logarithmic(values) {
  let least = Infinity, most = 0;
  for (const value of values) {
    if (value > 0 && value < least) least = value;
    if (value > most) most = value;
  }
  const first = most > 0 ? Math.floor(Math.log10(least)) : 0;
  const last = most > 0 ? Math.max(Math.ceil(Math.log10(most)), first + 1) : 1;
  return {
    place: (value) => (Math.log10(value) - first) / (last - first),
    ticks: Array.from({length: last - first + 1}, (_, i) => 10 ** (first + i)),
  };
}

// A round number that divides a range into two to five parts.
function niceTick(range) {
  const power = 10 ** Math.floor(Math.log10(Math.max(range, 1e-9) / 2));
  return [5, 2, 1].map((factor) => factor * power).find((tick) => tick <= range / 2) ?? power;
}
