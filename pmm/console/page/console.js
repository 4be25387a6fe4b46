// The console: takes the stream, draws once per animation frame, and posts what the operator wants.
import { Coefficients, Finished } from "./finished.js";
import { Plans } from "./plans.js";
import { Queue } from "./queue.js";
import { Readings } from "./readings.js";
import { Alarms, Facts, showDone, showProgress, showState } from "./status.js";
import { Stream, post } from "./stream.js";
import { byId, text } from "./svg.js";
import { Traces } from "./traces.js";
import { Until } from "./until.js";

const readings = new Readings(), traces = new Traces(), facts = new Facts(), alarms = new Alarms();
const finished = new Finished(), coefficients = new Coefficients();
const FIGURES = 4; // figures change in every fourth picture: nobody reads 25 numbers a second
let drawn = 0;
let holder = "nobody", priority = "", live = [], role = "", proposals = [], latest = null, due = false, shown = false, ended = false;

function draw() {
  due = false;
  const frame = latest, figures = drawn % FIGURES === 0;
  if (!frame) return;
  drawn += 1;
  traces.mark(frame.opened_s, frame.closed_s);
  traces.draw();
  readings.show(frame.needles, figures);
  showState(frame);
  alarms.show(frame);
  showButtons(frame);
  if (figures || !shown) {
    shown = true;
    facts.show({ ...frame, priority, live });
    showProgress(frame, queue);
    queue.show(frame, holder === "you" || role === "propose");
  }
  until.show(frame, holder === "you");
  showQuestion(frame);
}

function soon() {
  if (due) return;
  due = true;
  requestAnimationFrame(draw);
}

function takeFrame(frame) {
  if (latest && frame.run && frame.run !== latest.run) readings.clear();
  latest = frame;
  frame.traces.forEach((one) => traces.add(one));
  soon();
}

const commands = [...document.querySelectorAll("[data-command]")];

function showButtons(frame) {
  for (const button of commands) {
    const quick = button.dataset.command === "quick stop";
    button.disabled = !quick && (holder !== "you" || !frame.allowed.includes(button.dataset.command));
  }
}

function showQuestion(frame) {
  byId("question").hidden = !frame.question || until.asks(frame);
  text(byId("question-text"), frame.question);
}

function showDesk(desk) {
  holder = desk.holder;
  role = desk.role;
  queue.propose(proposals, role, holder === "you");
  const others = desk.browsers > 1 ? `, ${desk.browsers - 1} watching` : "";
  text(byId("desk"), { you: `You have control${others}`, other: role === "propose" ? "You propose: another browser has control and decides" : "You watch: another browser has control", nobody: "Nobody has control" }[holder]);
  byId("take").hidden = holder === "you" || desk.role !== "operate";
  document.body.dataset.holder = holder;
  if (latest) showButtons(latest);
}

function say(words, refused) {
  const box = byId("said");
  text(box, words);
  box.dataset.tone = refused ? "refused" : "";
  box.hidden = false;
  clearTimeout(say.timer);
  say.timer = setTimeout(() => { box.hidden = true; }, refused ? 15000 : 4000);
}

async function command(name) {
  const answer = await post(stream, "/api/command", { command: name });
  say(answer.ok ? answer.said : answer.error, !answer.ok);
}

function missed({ frames, seconds, happened }) {
  const told = happened.filter((one) => ["alarm", "outcome", "plan"].includes(one.kind)).map((one) => `${one.time_s} s ${one.kind}: ${one.text}`);
  const states = happened.filter((one) => one.kind === "state").length;
  text(byId("missed-text"), `This page was away for ${seconds.toFixed(1)} s and missed ${frames} frames, ${states} changes of state${told.length ? `; meanwhile ${told.slice(-6).join("; ")}` : ""}.`);
  byId("missed").hidden = false;
}

function begin(snapshot) {
  byId("lost").hidden = snapshot.connected;
  ended = !snapshot.connected;
  if (!snapshot.hello) return;
  priority = snapshot.hello.priority;
  text(byId("rig"), snapshot.hello.rig + (snapshot.hello.speed === 1 ? "" : `, ${snapshot.hello.speed} times as fast`));
  document.title = `${snapshot.hello.rig}: console`;
  readings.begin(snapshot.hello);
  traces.begin(snapshot.hello);
  snapshot.traces.forEach((one) => traces.add(one));
  finished.begin(snapshot.hello, snapshot.finished);
  coefficients.take(snapshot.figures);
  alarms.begin(snapshot.notices);
  byId("audit").replaceChildren();
  snapshot.audit.forEach(showDone);
  queue.take(snapshot.plans);
  live = snapshot.live;
  proposals = snapshot.proposals;
  until.take(snapshot.campaign);
  showDesk(snapshot.desk);
  if (snapshot.needles) readings.show(snapshot.needles);
  shown = false;
  if (snapshot.frame) { latest = snapshot.frame; soon(); }
  document.body.dataset.ready = "yes";
}

const stream = new Stream({
  snapshot: begin,
  frame: takeFrame,
  missed,
  desk: showDesk,
  notice: (one) => alarms.add(one),
  audit: (one) => showDone(one.entry),
  plans: (one) => queue.take(one.plans),
  proposals: (one) => { proposals = one.proposals; queue.propose(proposals, role, holder === "you"); },
  live: (one) => { live = one.live; },
  campaign: (one) => until.take(one.campaign),
  finished: (one) => {
    finished.add(one.entry);
    if (latest?.run === one.entry.run) readings.settle(one.entry.needles);
    plans.refresh();
  },
  figures: (one) => coefficients.take(one.figures),
  lost: (words) => {
    if (words.type) ended = true;
    text(byId("lost-text"), ended ? "The control loop has ended; this page comes back when the console is started again." : words);
    byId("lost").hidden = false;
  },
});
const plans = new Plans(stream);
const queue = new Queue(stream, say, finished);
const until = new Until(stream, say);

commands.forEach((one) => one.addEventListener("click", () => command(one.dataset.command)));
addEventListener("keydown", (event) => {
  if (event.key === "Escape" && !byId("take-dialog").open) command("quick stop");
});
byId("take").addEventListener("click", () => {
  if (holder === "other") byId("take-dialog").showModal();
  else post(stream, "/api/take-control", { confirm: true });
});
byId("take-dialog").addEventListener("close", () => {
  if (byId("take-dialog").returnValue === "yes") post(stream, "/api/take-control", { confirm: true });
});
byId("question").addEventListener("submit", async (event) => {
  event.preventDefault();
  const answer = await post(stream, "/api/answer", { question: latest.question, answer: byId("answer").value });
  if (answer.ok) byId("answer").value = "";
  else say(answer.error, true);
});
byId("far").addEventListener("click", () => {
  const far = document.body.dataset.view !== "far";
  document.body.dataset.view = far ? "far" : "";
  byId("far").setAttribute("aria-pressed", String(far));
  scrollTo(0, 0);
});
byId("missed-close").addEventListener("click", () => { byId("missed").hidden = true; });
addEventListener("pmm-theme", () => { if (traces.channels) traces.build(); });
globalThis.pmmFrames = () => stream.frames;
