// The needles of each dynamometer and its phasor. Only what has changed is written to the page.
import { attribute, digits, html, nice, plusMinus, svg, text } from "./svg.js";

const RADIUS = 78;
const SWEEP = 120; // degrees either side of the top

function onArc(share) {
  const angle = ((share * SWEEP - 90) * Math.PI) / 180;
  return `${(100 + RADIUS * Math.cos(angle)).toFixed(2)} ${(95 + RADIUS * Math.sin(angle)).toFixed(2)}`;
}

function arc(low, high) {
  const large = (high - low) * SWEEP > 180 ? 1 : 0;
  return `M ${onArc(low)} A ${RADIUS} ${RADIUS} 0 ${large} 1 ${onArc(high)}`;
}

class Dial {
  constructor(kind, name) {
    this.needle = svg("line", { class: "needle", x1: 100, y1: 95, x2: 100, y2: 30 });
    this.band = svg("path", { class: "band" });
    this.ends = [-1, 0, 1].map((at) => {
      const angle = ((at * SWEEP - 90) * Math.PI) / 180;
      return svg("text", { class: "scale", x: 100 + 52 * Math.cos(angle), y: 102 + 58 * Math.sin(angle) });
    });
    this.value = html("b");
    this.width = html("span");
    const face = svg("svg", { viewBox: "0 8 200 136", "aria-hidden": "true" }, [
      svg("path", { class: "face", d: arc(-1, 1) }), this.band, ...this.ends, this.needle,
      svg("circle", { class: "hub", cx: 100, cy: 95, r: 6 }),
    ]);
    this.root = html("div", { class: `reading ${kind}` }, html("span", {}, name), face, this.value, this.width);
  }

  show(value, width, full, figures = true) {
    if (figures) {
      const shown = digits(value, width);
      text(this.value, shown);
      attribute(this.value, "data-long", shown.length > 8 ? "yes" : "no");
      text(this.width, plusMinus(width) || " ");
    }
    const share = value === null ? 0 : Math.max(-1.05, Math.min(1.05, value / full));
    attribute(this.needle, "transform", `rotate(${(share * SWEEP).toFixed(1)} 100 95)`);
    const half = width > 0 ? Math.max(width / full, 0.004) : 0;
    const low = Math.max(-1, share - half), high = Math.min(1, share + half);
    attribute(this.band, "d", half && high > low ? arc(low, high) : "");
    if (full !== this.full) {
      this.full = full;
      [-full, 0, full].forEach((one, k) => text(this.ends[k], String(Number(one.toPrecision(3)))));
    }
  }
}

class Phasor {
  constructor(orders) {
    this.arrows = Array.from({ length: orders }, () => svg("line", { class: "arrow", x1: 80, y1: 80 }));
    this.tip = svg("circle", { class: "tip", r: 4 });
    this.cloud = svg("circle", { class: "cloud" });
    this.root = html("div", { class: "phasor" }, svg("svg", { viewBox: "0 0 160 160", role: "img", "aria-label": "phasor: in phase to the right, quadrature up" }, [
      svg("circle", { class: "ring", cx: 80, cy: 80, r: 70 }), svg("circle", { class: "ring", cx: 80, cy: 80, r: 35 }),
      svg("line", { class: "axis", x1: 6, y1: 80, x2: 154, y2: 80 }), svg("line", { class: "axis", x1: 80, y1: 154, x2: 80, y2: 6 }),
      svg("text", { class: "scale end", x: 156, y: 95 }, ["in phase"]), svg("text", { class: "scale start", x: 83, y: 14 }, ["quadrature"]),
      this.cloud, ...this.arrows, this.tip,
    ]));
  }

  show(row, widths, order, full) {
    const place = (k) => {
      const [s, c] = [row[2 * k - 1], row[2 * k]].map((one) => ((one ?? 0) / full) * 70);
      return [(80 + s).toFixed(1), (80 - c).toFixed(1)];
    };
    this.arrows.forEach((arrow, k) => {
      const [x, y] = place(k + 1);
      attribute(arrow, "x2", x);
      attribute(arrow, "y2", y);
      attribute(arrow, "class", k + 1 === order ? "arrow" : "arrow other");
    });
    const [x, y] = place(order);
    for (const one of [this.tip, this.cloud]) { attribute(one, "cx", x); attribute(one, "cy", y); }
    const half = Math.max(widths[2 * order - 1] ?? 0, widths[2 * order] ?? 0);
    attribute(this.cloud, "r", ((half / full) * 70).toFixed(1));
  }
}

export class Card {
  constructor(channel, orders) {
    this.scale = 0;
    this.dials = [new Dial("in-phase", "in phase"), new Dial("quadrature", "quadrature")];
    this.phasor = new Phasor(orders);
    this.note = html("span", { class: "quiet" });
    this.root = html("article", { class: "card", "data-channel": channel.name },
      html("h3", {}, html("span", {}, `${channel.name} [${channel.unit}]`), this.note),
      ...this.dials.map((one) => one.root), this.phasor.root);
  }

  show(row, widths, order, final, figures) {
    const parts = [row[2 * order - 1], row[2 * order]];
    const size = Math.max(...parts.map((one) => Math.abs(one ?? 0)), 1e-9);
    const wanted = nice(size * 1.15);
    if (wanted > this.scale || wanted < this.scale / 4 || order !== this.order) this.scale = wanted;
    this.order = order;
    this.dials.forEach((dial, k) => dial.show(parts[k], widths[2 * order - 1 + k], this.scale, figures));
    this.phasor.show(row, widths, order, nice(Math.max(...row.slice(1).map((one) => Math.abs(one ?? 0)), size) * 1.05));
    attribute(this.root, "data-final", final ? "yes" : "no");
    attribute(this.root, "data-empty", "no");
    if (figures) text(this.note, `mean ${digits(row[0], widths[0])}, amplitude ${digits(Math.hypot(parts[0] ?? 0, parts[1] ?? 0), Math.max(...widths.slice(1, 3)))}`);
  }

  clear() {
    this.dials.forEach((dial) => dial.show(null, null, this.scale || 1));
    this.phasor.show([0, ...this.phasor.arrows.flatMap(() => [0, 0])], [], this.order ?? 1, 1);
    text(this.note, "no reading");
    attribute(this.root, "data-empty", "yes");
  }
}
