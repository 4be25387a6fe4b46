// Cards with needles for the dynamometers, tiles for those that find no room, a table of all.
import { Card } from "./needles.js";
import { attribute, byId, digits, html, plusMinus, text } from "./svg.js";
import { Tile } from "./tiles.js";

const MANY = 8;
// One screen holds four cards, or two and six tiles, or one and fifteen tiles.
const room = (gauges) => (gauges <= 4 ? 4 : gauges <= MANY ? 2 : 1);
export const FORCES = ["N", "N m"];

export class Readings {
  begin(hello) {
    this.order = this.order ?? 1;
    this.channels = hello.channels;
    this.orders = hello.harmonics;
    const all = hello.channels.map((_, k) => k);
    const forces = all.filter((k) => FORCES.includes(hello.channels[k].unit));
    this.gauges = forces.length ? forces : all;
    this.large = (this.large ?? []).filter((k) => this.gauges.includes(k));
    if (!this.large.length) this.large = this.gauges.slice(0, room(this.gauges.length));
    this.build();
    this.choices();
    this.table();
    this.clear();
  }

  build() {
    this.cards = this.large.map((k) => ({ k, card: new Card(this.channels[k], this.orders) }));
    this.tiles = this.gauges.filter((k) => !this.large.includes(k))
      .map((k) => ({ k, tile: new Tile(this.channels[k], () => this.enlarge(k)) }));
    byId("cards").replaceChildren(...this.cards.map((one) => one.card.root));
    byId("tiles").replaceChildren(...this.tiles.map((one) => one.tile.root));
  }

  // A gauge that is chosen comes first; the last of the large ones makes room.
  enlarge(k) {
    this.large = [k, ...this.large.slice(0, -1)];
    this.build();
    if (this.last) this.show(this.last);
    else this.clear();
  }

  choices() {
    const box = byId("orders");
    box.querySelectorAll("label").forEach((one) => one.remove());
    for (let n = 1; n <= this.orders; n += 1) {
      const input = html("input", { type: "radio", name: "order", value: n });
      input.checked = n === this.order;
      input.addEventListener("change", () => { this.order = n; if (this.last) this.show(this.last); });
      box.append(html("label", {}, input, String(n)));
    }
  }

  table() {
    const heads = ["channel", "mean"];
    for (let n = 1; n <= this.orders; n += 1) heads.push(`in phase ${n}`, `quadrature ${n}`);
    byId("channel-table").tHead.replaceChildren(html("tr", {}, ...heads.map((one, k) => html("th", k ? { class: "n" } : {}, one))));
    this.cells = this.channels.map(() => Array.from({ length: heads.length - 1 }, () => html("td", { class: "n" })));
    byId("channel-table").tBodies[0].replaceChildren(...this.channels.map((one, k) =>
      html("tr", {}, html("td", {}, `${one.name} [${one.unit}]`), ...this.cells[k])));
  }

  clear() {
    this.last = this.standing = null;
    this.cards.forEach((one) => one.card.clear());
    this.tiles.forEach((one) => one.tile.clear());
    text(byId("finality"), "no reading");
  }

  // What is left of a run that has ended: its whole periods, not how it came to rest.
  settle(needles) { this.standing = needles; }

  // Needles move in every frame; figures and tiles only where asked for, and always at the end.
  show(needles, figures = true) {
    if (!needles) return this.rest();
    this.last = needles;
    const told = figures || needles.final;
    for (const { k, card } of this.cards) card.show(needles.values[k], needles.widths[k], this.order, needles.final, told);
    if (told) for (const { k, tile } of this.tiles) tile.show(needles.values[k], needles.widths[k], this.order, needles.final);
    text(byId("finality"), needles.final ? "final" : "provisional");
    attribute(byId("finality"), "data-final", needles.final ? "yes" : "no");
    if (!byId("all-channels").open || !figures) return;
    this.cells.forEach((row, k) => row.forEach((cell, at) =>
      text(cell, `${digits(needles.values[k][at], needles.widths[k][at])} ${plusMinus(needles.widths[k][at])}`)));
  }

  rest() {
    const standing = this.standing;
    this.standing = null;
    if (standing) this.show(standing);
    text(byId("finality"), this.last ? "last reading" : "no reading");
  }
}
