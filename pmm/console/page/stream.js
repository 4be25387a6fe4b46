// The stream of frames: comes back by itself, and says what was missed meanwhile.
const KEPT = "pmm-session";
const SEEN = "pmm-seen";
const A_MOMENT = 25; // frames: shorter gaps in which nothing happened are not worth a word

function session() {
  const own = sessionStorage.getItem(KEPT);
  if (own) return `session=${own}`;
  const last = localStorage.getItem(KEPT);
  return last ? `session=${last}&adopt=1` : "";
}

export class Stream {
  constructor(handlers) {
    this.handlers = handlers;
    this.session = "";
    this.frames = 0;
    this.seen = JSON.parse(localStorage.getItem(SEEN) || "null");
    this.wait = 250;
    addEventListener("pagehide", () => this.remember());
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/stream?${session()}`);
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = (event) => this.closed(event);
  }

  closed(event) {
    this.remember();
    const says = { 4001: "This session was opened in another window; reload to come back.", 1013: event.reason };
    this.handlers.lost(says[event.code]
      ?? "What is shown is old. The rig runs on; this page tries to come back.");
    if (event.code === 4001) return;
    this.askAgain();
    setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(4000, this.wait * 2);
  }

  // A console that was started anew knows no cookie of the old one: its token is asked again.
  async askAgain() {
    const answer = await fetch("/api/plans").catch(() => null);
    if (answer?.status === 401) location.assign("/login");
  }

  take(message) {
    if (message.type === "frame") {
      this.frames += 1;
      this.seen = { ...this.seen, n: message.n, at: Date.now() };
    } else if (message.type === "notice") {
      this.seen = { ...this.seen, id: message.id };
    } else if (message.type === "snapshot") {
      this.wait = 250;
      this.session = message.session;
      sessionStorage.setItem(KEPT, message.session);
      localStorage.setItem(KEPT, message.session);
      this.tellMissed(message);
    }
    const handler = this.handlers[message.type];
    if (handler) handler(message);
  }

  tellMissed(snapshot) {
    const now = snapshot.frame ? snapshot.frame.n : 0;
    const seen = this.seen;
    const newest = snapshot.notices.at(-1)?.id ?? 0;
    this.seen = { n: now, id: newest, at: Date.now(), began: snapshot.began };
    if (!seen || seen.n === undefined || seen.began !== snapshot.began) return;
    const happened = snapshot.notices.filter((one) => one.id > (seen.id ?? 0));
    if (now - seen.n < A_MOMENT && !happened.length) return;
    this.handlers.missed({ frames: now - seen.n, seconds: (Date.now() - seen.at) / 1000, happened });
  }

  remember() { if (this.seen) localStorage.setItem(SEEN, JSON.stringify(this.seen)); }
}

export async function post(stream, path, body) {
  try {
    const answer = await fetch(path, {
      method: "POST",
      headers: { "content-type": "application/json", "x-pmm-session": stream.session },
      body: JSON.stringify(body),
    });
    return { ok: answer.ok, ...(await answer.json()) };
  } catch (error) {
    return { ok: false, error: `the console does not answer: ${error.message}` };
  }
}
