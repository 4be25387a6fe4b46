// Plans: chosen, checked, queued; and the pages that campaigns have.
import { byId, html, runsOf, text } from "./svg.js";
import { post } from "./stream.js";

export class Plans {
  constructor(stream) {
    this.stream = stream;
    byId("plan-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.send(event.submitter?.dataset.do ?? "check");
    });
    addEventListener("focus", () => this.refresh()); // reports are written meanwhile
    this.refresh();
  }

  async refresh() {
    const answers = await Promise.all(["/api/plans", "/api/pages"].map((path) => fetch(path).catch(() => null)));
    if (!answers.every((one) => one?.ok)) return; // the stream says that the connection is lost
    const [plans, pages] = await Promise.all(answers.map((one) => one.json()));
    const chosen = byId("plan-name").value;
    byId("plan-name").replaceChildren(...plans.names.map((one) => html("option", one === chosen ? { selected: "" } : {}, one)));
    const links = pages.pages.map((one) =>
      html("a", { href: one.address, target: "_blank", rel: "noopener" }, `${one.folder}: ${one.name.replace(/\.(html|svg)$/, "")}`));
    byId("pages-list").replaceChildren(...(links.length ? links : [html("p", { class: "quiet" },
      "None yet. ", html("code", {}, "pmm report"), ", ", html("code", {}, "pmm gap --page"), " and ", html("code", {}, "pmm inertia --plot"),
      " write them into a campaign's folder.")]));
  }

  async send(what) {
    const body = { name: byId("plan-name").value, text: byId("plan-text").value };
    text(byId("plan-said"), what === "check" ? "checking" : "queueing");
    const answer = await post(this.stream, `/api/plans/${what}`, body);
    byId("plan-said").replaceChildren(...(answer.ok ? this.said(answer) : [html("p", { "data-verdict": "refuse" }, answer.error)]));
    if (!answer.ok) return;
    if (what === "queue") this.forget();
    this.refresh();
  }

  // A text that is queued must not be sent again in place of the plan that is chosen next.
  forget() {
    byId("plan-text").value = "";
    byId("plan-form").querySelector("details").open = false;
  }

  said({ plan, said }) {
    if (plan.chooses) return [html("p", {}, `${said ?? "a design"}: its runs are chosen one after the other, to ${plan.folder}`)];
    const minutes = Math.ceil(plan.runs.reduce((sum, one) => sum + one.duration_s, 0) / 60);
    const done = plan.complete ? `, ${plan.complete} complete already` : "";
    const first = html("p", {}, `${said ?? (plan.refused ? "the rig cannot run it" : "it can be run")}: ${runsOf(plan.runs.length)}${done}, at most ${minutes} min, to ${plan.folder}`);
    return [first, ...plan.findings.map((one) => html("p", { "data-verdict": one.verdict }, one.run ? `${one.run}: ${one.message}` : one.message))];
  }
}
