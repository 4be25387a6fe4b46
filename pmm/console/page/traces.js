// Traces of the last 20 s: a ring that new points are shifted into, drawn once per animation frame.
import { byId, html } from "./svg.js";

const POINTS = 2000;
const PER_CHART = 8;
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

class Scale {
  constructor() { this.low = -1; this.high = 1; }

  fit(arrays) {
    let low = Infinity, high = -Infinity;
    for (const values of arrays) for (let k = 0; k < POINTS; k += 1) {
      const one = values[k];
      if (one < low) low = one;
      if (one > high) high = one;
    }
    if (low > high) return;
    const span = Math.max(high - low, 3e-3 * Math.max(Math.abs(high), Math.abs(low)), 1e-9);
    const grown = low < this.low || high > this.high;
    if (grown || span < 0.5 * (this.high - this.low)) {
      this.low = low - 0.1 * span;
      this.high = high + 0.1 * span;
    }
  }
}

class Chart {
  constructor(ring, members, channels, height) {
    this.ring = ring;
    this.data = [ring.times, ...members.map((k) => ring.values[k])];
    this.scale = new Scale();
    this.members = members;
    this.box = html("div", { class: "chart" });
    const given = channels[members[0]].unit || "–";
    const [factor, unit] = given === "m" ? [1000, "mm"] : [1, given]; // as the set points are told
    const colours = members.map((_, k) => css(`--s${(k % PER_CHART) + 1}`));
    this.legend = html("div", { class: "legend" }, `[${unit}] `, ...members.map((k, at) => {
      const mark = html("i");
      mark.style.borderColor = colours[at];
      return html("span", {}, mark, channels[k].name);
    }));
    const values = (_plot, splits, _axis, _space, step) => {
      const places = Math.min(6, Math.max(0, Math.ceil(-Math.log10(step * factor) - 1e-9)));
      return splits.map((one) => (one * factor).toFixed(places));
    };
    const axis = { stroke: css("--quiet"), grid: { stroke: css("--line"), width: 1 }, ticks: { stroke: css("--line") }, font: "12px system-ui" };
    this.plot = new uPlot({
      width: 300, height,
      cursor: { show: false }, select: { show: false }, legend: { show: false },
      scales: { x: { time: false, range: () => this.ring.window() }, y: { range: () => [this.scale.low, this.scale.high] } },
      axes: [{ ...axis, size: 30 }, { ...axis, size: 64, space: 24, values }],
      series: [{}, ...members.map((_, at) => ({ stroke: colours[at], width: 1, points: { show: false }, spanGaps: false }))],
      hooks: { drawClear: [(plot) => this.gate(plot)] },
    }, this.data, this.box);
  }

  // Gates are marked behind the traces, with edges of their own so that no colour has to be seen.
  gate(plot) {
    const [from, to] = this.ring.window();
    for (const [opened, closed] of this.ring.gates) {
      const left = plot.valToPos(Math.max(opened, from), "x", true);
      const right = plot.valToPos(Math.min(closed ?? to, to), "x", true);
      if (right <= left) continue;
      const { ctx, bbox } = plot;
      ctx.save();
      ctx.fillStyle = css("--gate-wash");
      ctx.fillRect(left, bbox.top, right - left, bbox.height);
      ctx.fillStyle = css("--gate");
      if (opened >= from) ctx.fillRect(left, bbox.top, 3, bbox.height);
      if (closed !== null && closed <= to) ctx.fillRect(right - 3, bbox.top, 3, bbox.height);
      ctx.restore();
    }
  }

  draw() {
    if (!this.box.offsetParent) return;
    this.scale.fit(this.data.slice(1));
    this.plot.setData(this.data);
  }

  resize(width) { this.plot.setSize({ width, height: this.plot.height }); }
}

export class Traces {
  constructor() { this.charts = []; this.turn = 0; this.gates = []; this.box = byId("charts"); new ResizeObserver(() => this.fit()).observe(this.box); }

  begin(hello) {
    this.channels = hello.channels;
    this.step = 1 / hello.trace_rate_hz;
    this.times = new Float64Array(POINTS).map((_, k) => (k - POINTS) * this.step);
    this.values = hello.channels.map(() => new Float64Array(POINTS).fill(NaN));
    this.next = null;
    this.build();
  }

  build() {
    const groups = [];
    const rank = (unit) => { const at = ["N", "N m", "m"].indexOf(unit); return at < 0 ? 9 : at; };
    const units = [...new Set(this.channels.map((one) => one.unit))].sort((a, b) => rank(a) - rank(b));
    for (const unit of units) {
      const members = this.channels.map((one, k) => (one.unit === unit ? k : -1)).filter((k) => k >= 0);
      for (let k = 0; k < members.length; k += PER_CHART) groups.push(members.slice(k, k + PER_CHART));
    }
    const [room, most] = innerWidth <= 700 ? [470, 240] : [this.channels.length > PER_CHART ? 640 : 470, 400];
    const height = Math.max(110, Math.min(most, Math.floor((room - 22 * groups.length) / groups.length)));
    this.charts.forEach((one) => one.plot.destroy());
    this.charts = groups.map((members) => new Chart(this, members, this.channels, height));
    this.width = 0;
    this.box.replaceChildren(...this.charts.flatMap((one) => [one.legend, one.box]));
    this.fit();
    this.charts.forEach((one) => one.draw()); // no frame may come to do it
  }

  fit() {
    const width = this.box.clientWidth;
    if (!width || width === this.width) return;
    this.width = width;
    this.charts.forEach((one) => one.resize(width));
  }

  // Gates of the last 20 s; a gate that closes replaces itself as it was open, and one whose run was
  // stopped ends where it was last seen.
  mark(opened, closed) {
    const [from, now] = this.times ? this.window() : [0, 0];
    this.gates = this.gates.filter(([one]) => one !== opened).map(([one, end]) => [one, end ?? now])
      .filter(([, end]) => end > from);
    if (opened !== null) this.gates.push([opened, closed]);
  }

  window() { const end = this.times[POINTS - 1]; return [end - (POINTS - 1) * this.step, end]; }

  add(trace) {
    const count = trace.values.length ? trace.values[0].length : 0;
    if (!count) return;
    const hole = this.next === null ? 0 : Math.min(Math.max(trace.first - this.next, 0), POINTS);
    this.next = trace.first + count;
    const shift = Math.min(hole + count, POINTS);
    const end = trace.start_s + (count - 1) * this.step;
    this.times.copyWithin(0, shift);
    for (let k = 0; k < shift; k += 1) this.times[POINTS - 1 - k] = end - k * this.step;
    if (hole) for (let k = 0; k < POINTS; k += 1) this.times[POINTS - 1 - k] = end - k * this.step;
    trace.values.forEach((fresh, at) => {
      const ring = this.values[at];
      ring.copyWithin(0, shift);
      ring.fill(NaN, POINTS - shift);
      for (let k = Math.max(0, count - POINTS); k < count; k += 1) ring[POINTS - count + k] = fresh[k] ?? NaN;
    });
  }

  // More than one chart's worth of traces take turns, so that a slow machine keeps up.
  draw() {
    const turns = this.channels.length > PER_CHART ? 2 : 1;
    this.turn = (this.turn + 1) % turns;
    this.charts.forEach((one, k) => { if (k % turns === this.turn) one.draw(); });
  }
}
