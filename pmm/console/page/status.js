// State, gate, shaft, set points, health and progress.
import { attribute, byId, digits, html, text } from "./svg.js";

const TONES = { fault: "fault", idle: "quiet", done: "quiet", stopped: "quiet", setting: "waits", pausing: "waits", homing: "waits" };
const SIGNS = { fault: "▲ ", idle: "○ ", done: "✓ ", stopped: "■ ", "gate open": "● ", hold: "‖ " };
const GATES = { closed: "closed", armed: "armed", open: "open", held: "hold" };

export function showState(frame) {
  attribute(byId("state"), "data-tone", TONES[frame.state] ?? "moves");
  text(byId("state-name"), (SIGNS[frame.state] ?? "▶ ") + frame.state);
  text(byId("state-run"), frame.run ? `${frame.run}, ${frame.run_number} of ${frame.run_count}` : "no run");
  const gate = GATES[frame.gate];
  attribute(byId("gate"), "data-gate", gate);
  text(byId("gate-name"), gate);
  text(byId("gate-line"), frame.opened_s === null ? "" : frame.closed_s === null
    ? `open since ${(frame.time_s - frame.opened_s).toFixed(1)} s` : `lasted ${(frame.closed_s - frame.opened_s).toFixed(2)} s`);
  text(byId("periods"), String(frame.periods));
  text(byId("wanted"), String(frame.wanted));
  byId("period-bar").value = frame.wanted ? frame.periods / frame.wanted : 0;
  text(byId("shaft"), frame.shaft_hz === null ? "–" : frame.shaft_hz.toFixed(3));
  text(byId("shaft-set"), frame.set ? `set ${frame.set.frequency_hz.toFixed(3)} Hz` : "set –");
}

const PLACES = { m: [1000, "mm", 2], rad: [180 / Math.PI, "deg", 2] };

function facts(frame) {
  const found = [];
  const set = { eccentricity: frame.set?.eccentricity_m, phase: frame.set?.strut_phase_rad };
  for (const [name, unit, value] of frame.axes) {
    const [factor, shown, places] = PLACES[unit] ?? [1, unit, 3];
    const say = (one) => (one === null || one === undefined ? "–" : (one * factor).toFixed(places));
    found.push([name, `${say(value)} ${shown}, set ${say(set[name])}`]);
  }
  found.push(["carriage, set", frame.set ? `${digits(frame.set.carriage_speed_m_s)} m/s in ${frame.set.medium}` : "–"]);
  const bus = frame.bus;
  const wrong = bus.faults.length ? "fault latched" : "NOT IN ORDER";
  const busText = !bus.nodes ? "none" : bus.ok ? `in order, ${bus.nodes} nodes` : wrong;
  found.push(["bus", busText, bus.ok ? "" : "bad"]);
  if (bus.nodes) found.push(["error frames", String(bus.error_frames)]);
  const free = frame.free_bytes;
  found.push(["disk", free === null ? "no plan yet" : `${(free / 1e9).toFixed(1)} GB left`, free !== null && free < 1e9 ? "bad" : ""]);
  const loop = frame.loop;
  const late = loop.cycles ? `${(loop.p99_s * 1e3).toFixed(2)} ms, worst ${(loop.worst_s * 1e3).toFixed(1)}` : "–";
  found.push(["loop late, 99 %", late]);
  found.push(["late cycles", loop.cycles ? `${loop.late} of the last ${loop.cycles}` : "–"]);
  if (frame.priority) found.push(["loop priority", frame.priority]);
  for (const one of frame.live ?? []) {
    const how = one.connected ? "in order" : one.trouble ? "not connected" : "not yet connected";
    found.push([`live values, ${one.name}`, `${how}${one.dropped ? `, ${one.dropped} dropped` : ""}`, one.dropped || one.trouble ? "bad" : ""]);
  }
  found.push(["rig time", `${frame.time_s.toFixed(1)} s`]);
  return found;
}

export class Facts {
  constructor() { this.rows = new Map(); }

  show(frame) {
    for (const [name, value, tone] of facts(frame)) {
      let cell = this.rows.get(name);
      if (!cell) {
        cell = html("dd");
        byId("facts").append(html("dt", {}, name), cell);
        this.rows.set(name, cell);
      }
      text(cell, value);
      attribute(cell, "data-tone", tone ?? "");
    }
  }
}

export function showProgress(frame, queue) {
  const plan = queue.plans[frame.plan], left = queue.secondsLeft(frame);
  text(byId("campaign"), plan ? plan.name : "no plan");
  const all = frame.state === "done" && !frame.next.length;
  const done = all ? frame.run_count : Math.max(frame.run_number - 1, 0) + (frame.wanted ? frame.periods / frame.wanted : 0);
  byId("campaign-bar").value = frame.run_count ? done / frame.run_count : 0;
  const hours = left >= 3600 ? `${Math.floor(left / 3600)} h ` : "";
  const where = all ? `${frame.run_count === 1 ? "its run is" : `all ${frame.run_count} runs are`} done`
    : `run ${frame.run_number} of ${frame.run_count}, at most ${hours}${Math.ceil((left % 3600) / 60)} min left`;
  text(byId("campaign-line"), plan ? `${where}; recorded to ${plan.folder}` : "");
  const next = frame.next.map((name) => {
    const run = plan?.runs.find((one) => one.name === name);
    return run && run.frequency_hz ? `${name}: ${run.frequency_hz} Hz, ${(run.eccentricity_m * 1000).toFixed(1)} mm` : name;
  });
  const key = next.join("|");
  if (key !== showProgress.key) {
    showProgress.key = key;
    byId("next").replaceChildren(...next.map((one) => html("li", {}, one)));
  }
}

const DONE = 200; // lines of who did what

export function showDone(entry) {
  const who = [entry.name || entry.address, entry.session].filter(Boolean).join(", ");
  byId("audit").prepend(html("li", { "data-taken": entry.taken ? "yes" : "no" }, html("time", { datetime: entry.utc }, entry.utc.slice(11, 19)),
    ` ${who}: ${entry.action} ${entry.given} ${entry.taken ? "✓" : "refused"} ${entry.said}`));
  while (byId("audit").children.length > DONE) byId("audit").lastChild.remove();
}

const WORDS = { state: "state: ", outcome: "ended: ", plan: "plan: ", note: "note on " };

export class Alarms {
  constructor() { this.box = byId("alarms"); this.count = 0; }

  begin(notices) { this.box.replaceChildren(); this.count = 0; notices.forEach((one) => this.add(one)); }

  add(notice) {
    if (notice.kind === "alarm") {
      this.count += 1;
      text(byId("alarm-now"), notice.text);
    }
    const time = html("time", {}, `${notice.time_s.toFixed(1)} s`);
    this.box.prepend(html("li", { "data-kind": notice.kind }, time, `${WORDS[notice.kind] ?? ""}${notice.text}`));
    while (this.box.children.length > 60) this.box.lastChild.remove();
    text(byId("alarm-count"), this.count ? `${this.count} so far` : "none");
  }

  // The reason of a fault stands on top until it is reset.
  show(frame) {
    const fault = frame.state === "fault";
    attribute(byId("alarms-panel"), "data-alarm", fault ? "yes" : "no");
    byId("alarm-now").hidden = !fault;
  }
}
