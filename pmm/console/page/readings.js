// Cards with needles for the dynamometers, and a table of all channels.
import { Card } from "./needles.js";
import { attribute, byId, digits, html, plusMinus, text } from "./svg.js";

const LARGE = 4;

export class Readings {
  begin(hello) {
    this.order = this.order ?? 1;
    this.channels = hello.channels;
    this.orders = hello.harmonics;
    const forces = hello.channels.map((one, k) => [one, k]).filter(([one]) => ["N", "N m"].includes(one.unit));
    this.cards = (forces.length ? forces : hello.channels.map((one, k) => [one, k])).slice(0, LARGE)
      .map(([one, k]) => ({ k, card: new Card(one, hello.harmonics) }));
    byId("cards").replaceChildren(...this.cards.map((one) => one.card.root));
    this.choices();
    this.table();
    this.clear();
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
    this.last = null;
    this.cards.forEach((one) => one.card.clear());
    text(byId("finality"), "no reading");
  }

  // Needles move in every frame; figures only where asked for, and always at the end.
  show(needles, figures = true) {
    if (!needles) return text(byId("finality"), this.last ? "last reading" : "no reading");
    this.last = needles;
    for (const { k, card } of this.cards) card.show(needles.values[k], needles.widths[k], this.order, needles.final, figures || needles.final);
    text(byId("finality"), needles.final ? "final" : "provisional");
    attribute(byId("finality"), "data-final", needles.final ? "yes" : "no");
    if (!byId("all-channels").open || !figures) return;
    this.cells.forEach((row, k) => row.forEach((cell, at) =>
      text(cell, `${digits(needles.values[k][at], needles.widths[k][at])} ${plusMinus(needles.widths[k][at])}`)));
  }
}
