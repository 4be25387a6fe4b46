// The queue: plans and their runs before they are made, edited, moved, held, taken out.
import { movable } from "./order.js";
import { byId, html, runsOf } from "./svg.js";
import { post } from "./stream.js";

const MOST = 60; // runs of a plan that are listed; those behind them follow as these are made
const RAD = Math.PI / 180;
const AUTHOR = "pmm-author";
const FIELDS = [ // what is edited: its name when posted, its name in a plan's picture, label, size of the unit
  ["frequency_hz", "frequency_hz", "Hz", 1],
  ["eccentricity_m", "eccentricity_m", "mm", 1e-3],
  ["strut_phase_rad", "phase_rad", "deg", RAD],
  ["carriage_speed_m_s", "speed_m_s", "m/s", 1],
  ["periods", "periods", "periods", 1],
];
const shown = (value, unit) => String(Number((value / unit).toPrecision(6)));

export class Queue {
  constructor(stream, say, finished) {
    this.stream = stream;
    this.say = say;
    this.finished = finished;
    this.plans = {};
    this.counted = {}; // what is left of the plans, until one changes or a run ends
    this.open = new Set(); // plans whose runs are listed
    byId("note-author").value = localStorage.getItem(AUTHOR) ?? "";
    byId("note-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.note();
    });
  }

  take(plans) { this.plans = plans; this.key = ""; }

  show(frame, mine) {
    const numbers = [frame.plan, ...frame.queue].filter((one) => this.plans[one]);
    const key = [mine, numbers, frame.run, this.finished.entries.length].join();
    if (key === this.key || byId("queue").querySelector("form")) return; // what is typed is not drawn over
    this.key = key;
    const focus = document.activeElement?.dataset.key;
    byId("queue").replaceChildren(...numbers.map((one) => this.plan(one, frame)));
    for (const one of byId("queue").querySelectorAll("button")) one.disabled = !mine;
    this.offer(numbers, frame);
    if (focus) byId("queue").querySelector(`[data-key="${CSS.escape(focus)}"]`)?.focus();
  }

  plan(number, frame) {
    const plan = this.plans[number], waits = frame.plan !== number;
    const left = plan.chooses ? [] : this.left(number).filter((one) => waits || one.name !== frame.run || frame.state === "idle");
    const held = left.length > 0 && left.every((one) => plan.held.includes(one.name));
    const count = plan.chooses ? "a design" : runsOf(left.length);
    const words = `${plan.name}, ${count} ${held ? "(held) " : waits ? "(waits) " : ""}`;
    const order = () => frame.queue;
    const row = waits
      ? movable(number, { order, move: (one, to) => this.move(one, "", to - order().indexOf(one)), remove: (one) => this.drop(one) }, words)
      : html("li", {}, words);
    if (!plan.chooses) row.append(this.holding(number, "", held, plan.name), " ");
    row.append(this.button("Take out", `Take out ${plan.name}`, () => this.drop(number)));
    if (left.length) row.append(this.runs(number, plan, left));
    return row;
  }

  // Runs under way or still to be made, those that are held too: as the loop, which leaves out what ended in the plan
  // itself, and what another one has completed in the folder.
  left(number) {
    const plan = this.plans[number], entries = this.finished.entries;
    if (this.counted.entries !== entries || this.counted.plans !== this.plans) this.counted = { entries, plans: this.plans };
    if (!this.counted[number]) {
      const ended = new Set(entries.filter((one) => one.plan === number || (one.folder === plan.folder && one.outcome === "complete")).map((one) => one.run));
      this.counted[number] = plan.runs.filter((one) => !ended.has(one.name));
    }
    return this.counted[number];
  }

  // At most so long, in seconds, until the plan under way has ended.
  secondsLeft(frame) {
    if (!this.plans[frame.plan]) return 0;
    const { held } = this.plans[frame.plan];
    return this.left(frame.plan).reduce((sum, one) => sum + (held.includes(one.name) ? 0 : one.duration_s), 0);
  }

  runs(number, plan, left) {
    const list = html("ol", { "aria-label": `Runs of ${plan.name}; Alt and the arrow keys move one, Delete holds it` });
    const box = html("details", this.open.has(number) ? { open: "" } : {}, html("summary", {}, "Runs"), list);
    box.addEventListener("toggle", () => this.open[box.open ? "add" : "delete"](number));
    const order = () => left.map((one) => one.name), places = plan.runs.map((one) => one.name);
    const move = (name, to) => left[to] && this.move(number, name, places.indexOf(left[to].name) - places.indexOf(name));
    list.append(...left.slice(0, MOST).map((run) => {
      const held = plan.held.includes(run.name), facts = run.frequency_hz
        ? `${run.frequency_hz} Hz, ${shown(run.eccentricity_m, 1e-3)} mm, ${run.periods} periods` : run.kind;
      const item = movable(run.name, { order, move, remove: (name) => this.hold(number, name, true) },
        `${run.name}: ${facts}${held ? ", held" : ""}${run.changed.length ? `, ${run.changed.join(", ")}` : ""} `);
      if (run.kind === "oscillation") item.append(this.button("Edit", `Edit ${run.name}`, () => item.append(this.form(number, run))), " ");
      item.append(this.holding(number, run.name, held, run.name));
      return item;
    }));
    if (left.length > MOST) list.append(html("li", { class: "quiet" }, `and ${left.length - MOST} more`));
    return box;
  }

  form(number, run) {
    const fields = FIELDS.filter(([, name]) => name !== "phase_rad" || run.motion === "phase");
    const close = () => { form.remove(); this.key = ""; };
    const form = html("form", { "aria-label": `Settings of ${run.name}` }, ...fields.map(([key, name, label, unit]) =>
      html("label", {}, html("input", { name: key, value: shown(run[name], unit), size: "6", inputmode: "decimal" }), ` ${label}`)),
    html("button", { class: "small" }, "Change"), this.button("Leave it", `Leave ${run.name} as it is`, close));
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      const body = { number, run: run.name };
      for (const [key, name, , unit] of fields) {
        const given = form.elements[key].value.trim();
        if (given !== shown(run[name], unit)) body[key] = Number(given.replace(",", ".")) * unit;
      }
      if (await this.send("edit", body)) close();
    });
    return form;
  }

  // What a note may be on: each campaign, the run under way, those that ended and those to come.
  offer(numbers, frame) {
    const box = byId("note-run"), chosen = box.value;
    const options = numbers.flatMap((number) => {
      const plan = this.plans[number], ended = this.finished.entries.filter((one) => one.folder === plan.folder).map((one) => one.run);
      const names = new Set([...(number === frame.plan && frame.run ? [frame.run] : []), ...ended.toReversed(), ...plan.runs.map((one) => one.name)]);
      return [["", plan.name], ...[...names].slice(0, MOST).map((one) => [one, `${plan.name}, ${one}`])].map(([run, words]) => [`${number} ${run}`, words]);
    });
    box.replaceChildren(...options.map(([value, words]) => html("option", { value, ...(value === chosen ? { selected: "" } : {}) }, words)));
    byId("note-form").hidden = !options.length;
  }

  // What others propose: whoever has control decides, whoever has proposed may withdraw.
  propose(proposals, role, mine) {
    byId("proposals").replaceChildren(...proposals.map((one) => {
      const act = (what) => this.send(what, { number: one.number }, "proposals");
      const no = role === "propose" ? "Withdraw" : "Refuse";
      const buttons = [this.button(no, `${no} ${one.text}`, () => act("refuse"))];
      if (role === "operate") buttons.unshift(this.button("Approve", `Approve ${one.text}`, () => act("approve")), " ");
      for (const button of buttons) if (role === "operate" && button.tagName) button.disabled = !mine;
      return html("li", {}, `${one.name || "somebody"} proposes: ${one.text} `, ...(role === "watch" ? [] : buttons));
    }));
  }

  async note() {
    const [, number, run] = /^(\d+) (.*)$/.exec(byId("note-run").value);
    const author = byId("note-author").value.trim();
    localStorage.setItem(AUTHOR, author);
    if (await this.send("note", { number: Number(number), run, text: byId("note-text").value.trim(), author })) byId("note-text").value = "";
  }

  button(words, label, act) {
    const made = html("button", { class: "small", type: "button", "aria-label": label }, words);
    made.addEventListener("click", act);
    return made;
  }

  holding(number, run, held, name) {
    const words = held ? "Release" : "Hold";
    return this.button(words, `${words} ${name}`, () => this.hold(number, run, !held));
  }

  hold(number, run, held) { return this.send("hold", { number, run, held }); }

  move(number, run, by) { return by ? this.send("move", { number, run, by }) : null; }

  drop(number) { return this.send("drop", { number }); }

  async send(what, body, where = "plans") {
    const answer = await post(this.stream, `/api/${where}/${what}`, body);
    this.say(answer.ok ? answer.said : answer.error, !answer.ok);
    return answer.ok;
  }
}
