// A campaign that chooses its runs: what is known, what is proposed, and the operator's answer.
import { movable } from "./order.js";
import { attribute, byId, html, text } from "./svg.js";
import { post } from "./stream.js";

const ASKS = "Approve of these runs?"; // the question that the terminal asks as well

export class Until {
  constructor(stream, say) {
    this.stream = stream;
    this.say = say;
    this.order = []; // numbers of the proposed runs, from 1
    this.question = "";
    byId("approve").addEventListener("click", () => this.approve());
    byId("keep").addEventListener("click", () => this.answer("k"));
    byId("reject").addEventListener("click", () => this.answer("n"));
    byId("restore").addEventListener("click", () => this.restore());
  }

  asks(frame) { return Boolean(this.told) && frame.question.startsWith(ASKS); }

  take(told) {
    this.told = told;
    byId("until").hidden = !told;
    if (!told) return;
    text(byId("until-made"), `${told.runs} ${told.runs === 1 ? "run" : "runs"}, ${told.time}`);
    byId("known").replaceChildren(...told.known.map(bar), ...told.causes.map(cause));
    byId("until-notes").replaceChildren(...told.notes.map((one) => html("li", {}, one)));
    const remark = told.remark ? ` (${told.remark})` : "";
    text(byId("until-said"), told.ending ? `Ended: ${told.ending}${remark}`
      : told.proposed.length ? `Proposed${remark}, ${told.left}:` : `As planned: ${told.kept.length} more, ${told.left}`);
    this.restore();
  }

  restore() {
    this.order = (this.told?.proposed ?? []).map((_, k) => k + 1);
    this.draw();
  }

  draw(focus) {
    byId("proposed").replaceChildren(...this.order.map((number) => this.item(number)));
    if (focus) byId("proposed").querySelector(`[data-key="${focus}"]`)?.focus();
    this.enable();
  }

  item(number) {
    const one = this.told.proposed[number - 1];
    const away = html("button", { class: "small", "aria-label": `Leave out ${one.what}` }, "Leave out");
    away.addEventListener("click", () => this.leaveOut(number));
    const why = one.why ? [html("small", {}, one.why)] : [];
    return movable(number, { order: () => this.order, move: (dragged, to) => this.move(dragged, to), remove: (left) => this.leaveOut(left) },
      `${one.what}, ${one.time} `, away, ...why);
  }

  move(number, to) {
    if (!this.order.includes(number) || to < 0 || to >= this.order.length) return;
    this.order = this.order.filter((one) => one !== number);
    this.order.splice(to, 0, number);
    this.draw(number);
  }

  leaveOut(number) {
    if (this.order.length < 2) return; // none at all is a rejection, which has a button of its own
    const place = this.order.indexOf(number);
    this.order.splice(place, 1);
    this.draw(this.order[Math.min(place, this.order.length - 1)]);
  }

  show(frame, mine) {
    this.question = this.asks(frame) ? frame.question : "";
    this.mine = mine;
    this.enable();
  }

  enable() {
    const asked = Boolean(this.question) && Boolean(this.mine);
    byId("until-buttons").hidden = !asked;
    byId("keep").hidden = !this.question.includes("k: ");
    for (const one of byId("proposed").querySelectorAll("button")) one.disabled = !asked;
    attribute(byId("proposed"), "data-asked", asked ? "yes" : "no");
  }

  approve() {
    const changed = this.order.length < this.told.proposed.length || this.order.some((one, k) => one !== k + 1);
    this.answer(changed ? `y ${this.order.join(" ")}` : "y");
  }

  async answer(given) {
    const answer = await post(this.stream, "/api/answer", { question: this.question, answer: given });
    this.say(answer.ok ? answer.said : answer.error, !answer.ok);
  }
}

// A bar closes as the uncertainty comes down to what is asked for.
function bar(one) {
  const known = one.standard_uncertainty !== null;
  const share = known ? Math.min(1, one.wanted / one.standard_uncertainty) : 0;
  const said = known ? `${one.value} ± ${one.standard_uncertainty} ${one.unit}` : "unknown";
  const mostly = one.mostly ? `; most of it from ${one.mostly}` : "";
  return html("li", { "data-met": one.met ? "yes" : "no" },
    html("span", {}, `${one.met ? "✓ " : ""}${one.name}: ${said}`),
    html("progress", { max: 1, value: share, "aria-label": `${one.name}, how near to what is asked for` }),
    html("small", {}, `${one.wanted} asked for${mostly}`));
}

// So does that of a cause, as its probability comes up to what makes it known.
function cause(one) {
  const alike = one.alike.length ? `; alike in these runs: ${one.alike.join(", ")}` : "";
  return html("li", { "data-met": one.met ? "yes" : "no" },
    html("span", {}, `${one.met ? "✓ " : ""}${one.name}: ${one.probability.toFixed(3)}`),
    html("progress", { max: 1, value: Math.min(1, one.probability / one.wanted), "aria-label": `${one.name}, how near to being known` }),
    html("small", {}, `known above ${one.wanted}${alike}`));
}
