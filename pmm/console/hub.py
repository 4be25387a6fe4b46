"""What the server knows of the rig, and what of it each browser lacks."""

import asyncio
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, Final

from pmm.console.audit import MOST
from pmm.console.client import Client
from pmm.console.desk import Desk, Holder
from pmm.console.encoding import (
    campaign_picture,
    encode,
    hello_picture,
    needles_picture,
    notice_picture,
    outcome_picture,
)
from pmm.console.limits import SILENT_S
from pmm.console.live.outlet import OutletStatus
from pmm.console.messages import (
    WRITTEN,
    CampaignLook,
    Frame,
    Hello,
    LoopMessage,
    Needles,
    Notice,
    Reply,
)
from pmm.console.pictures import Pictures
from pmm.console.request_body import Requester
from pmm.console.security import VisitorRole

_NOTICES: Final = 200


class Hub:
    """Takes what the loop tells, and keeps it as the texts that browsers get.

    Parameters
    ----------
    replied
        Takes the replies to orders.
    written
        Told when a campaign's file holds one more run.
    lapsed
        Told whose control has lapsed.
    utc
        Date and time in ISO 8601.

    Attributes
    ----------
    clients
        The browsers, by their sessions.
    last
        The latest frame.
    news
        Set when there is something to send.
    """

    def __init__(
        self,
        replied: Callable[[Reply], None],
        written: Callable[[Notice], None],
        lapsed: Callable[[Requester], None],
        utc: Callable[[], str],
    ) -> None:
        self.desk = Desk()
        self.clients: dict[str, Client] = {}
        self.last: Frame | None = None
        self.news = asyncio.Event()
        self._replied, self._written, self._utc = replied, written, utc
        self._lapsed = lapsed
        self._silence: asyncio.TimerHandle | None = None
        self._silent: Requester | None = None  # has control, and no page open
        self._hello, self._connected = "null", False
        self._plans = self._figures = "{}"
        self._proposals = "[]"
        self._campaign = "null"
        self._live: dict[str, OutletStatus] = {}
        self._finished: list[str] = []
        self._notices: deque[str] = deque(maxlen=_NOTICES)
        self._done: deque[str] = deque(maxlen=MOST)
        self._count, self._began = 0, utc()
        self._needles: Needles | None = None
        self._pictures = Pictures()
        self._common = ""

    def take(self, message: LoopMessage) -> None:
        """Take a message of the loop: a frame, a notice, a reply or a look at a campaign."""
        if isinstance(message, Frame):
            self.last = message
            self._needles = message.needles or self._needles
            self._pictures.take(message)
            self._changed()
        elif isinstance(message, Notice):
            self._notice(message)
        elif isinstance(message, Reply):
            self._replied(message)
        elif isinstance(message, CampaignLook):
            self._campaign = encode(campaign_picture(message))
            self._tell(f'{{"type":"campaign","campaign":{self._campaign}}}')
        else:
            self._begin(message)

    def lost(self) -> None:
        """Say that the loop has ended."""
        self._connected = False
        self._tell(encode({"type": "lost"}))

    def tell_plans(self, plans: str) -> None:
        """Keep and hand on the plans that were queued, as JSON: their pictures by their numbers."""
        self._plans = plans
        self._tell(f'{{"type":"plans","plans":{plans}}}')

    def tell_proposals(self, proposals: Sequence[Mapping[str, Any]]) -> None:
        """Keep and hand on the changes of the queue that are proposed."""
        self._proposals = encode(proposals)
        self._tell(f'{{"type":"proposals","proposals":{self._proposals}}}')

    def tell_figures(self, figures: dict[str, Any]) -> None:
        """Keep and hand on what was worked out of runs that ended."""
        self._figures = encode(figures)
        self._tell(f'{{"type":"figures","figures":{self._figures}}}')

    def tell_done(self, record: Mapping[str, Any]) -> None:
        """Keep and hand on who did what."""
        entry = encode(record)
        self._done.append(entry)
        self._tell(f'{{"type":"audit","entry":{entry}}}')

    def tell_live(self, outlets: Sequence[OutletStatus]) -> None:
        """Keep and hand on how the outlets of live values are; trouble is an alarm once."""
        for outlet in outlets:
            before = self._live.get(outlet.name)
            if outlet.trouble and (before is None or not before.trouble):
                self.say("alarm", f"{outlet.name}: {outlet.trouble}")
            elif before is not None and before.trouble and outlet.connected:
                self.say("live", f"{outlet.name}: connected")
        if outlets:
            self._live = {outlet.name: outlet for outlet in outlets}
            self._tell(f'{{"type":"live","live":{self._live_picture()}}}')

    def join(self, client: Client) -> None:
        """Let a browser come; an older page of the same session ends."""
        before = self.clients.get(client.session)
        if before is not None:
            before.replace()
        self.clients[client.session] = client
        if client.who.visitor.role is VisitorRole.OPERATE:
            self.desk.arrive(client.who)
        self.follow_control()

    def part(self, client: Client) -> None:
        """Send a browser nothing more, and forget it."""
        client.stop()
        if self.clients.get(client.session) is client:
            del self.clients[client.session]
            self.follow_control()

    def follow_control(self) -> None:
        """Note that control may have moved; tell the browsers.

        Where the holder's page is not open its silence is counted, from when it began: whoever else
        comes or goes does not begin it anew.
        """
        self.news.set()
        holder = self.desk.holder if self.in_control is None else None
        if holder is self._silent:
            return
        if self._silence is not None:
            self._silence.cancel()
        self._silent, self._silence = holder, None
        if holder is not None:
            clock = asyncio.get_running_loop()
            self._silence = clock.call_later(SILENT_S, self._let_lapse, holder)

    def hear_holder(self) -> None:
        """Note that whoever has control was heard of: a silence begins anew."""
        if self._silence is not None:
            self._silence.cancel()
        self._silent = self._silence = None
        self.follow_control()

    def _let_lapse(self, who: Requester) -> None:
        self.desk.give_back(who.session)
        self.follow_control()
        self._lapsed(who)

    def is_expected(self, session: str) -> bool:
        """Whether a session has a place however many there are: it has control, or one already."""
        return session in self.clients or self.desk.seen_from(session) is Holder.YOU

    @property
    def in_control(self) -> Client | None:
        """The browser that has control, if its page is open."""
        holder = self.desk.holder
        return None if holder is None else self.clients.get(holder.session)

    def due(self, client: Client) -> list[str]:
        """Return what a browser lacks, and take it for sent."""
        pictures, desk = self._pictures, self._desk(client)
        texts: list[str] = []
        if client.behind:
            client.behind = False
            texts.append(self._snapshot(client.session, desk))
        else:
            texts += client.take()
            if client.desk != desk:
                texts.append(desk)
            if client.frame != pictures.number:
                texts.append(pictures.frame(client.piece))
        client.frame, client.piece, client.desk = pictures.number, pictures.next_piece, desk
        return texts

    def say(self, kind: str, text: str) -> None:
        """Keep and hand on something that the server has found, at the rig's time."""
        time_s = self.last.status.time_s if self.last is not None else 0.0
        self.add_notice(Notice(kind, time_s, text))

    def add_notice(self, notice: Notice) -> None:
        """Keep and hand on what happened."""
        self._count += 1
        text = encode(notice_picture(notice, self._count, self._utc()))
        self._notices.append(text)
        self._tell(text)

    def _snapshot(self, session: str, desk: str) -> str:
        """Return everything that a page needs to begin, or to go on after a gap."""
        snapshot = encode({"type": "snapshot", "session": session})
        if not self._common:
            self._common = (
                f'"began":{encode(self._began)},"connected":{encode(self._connected)},'
                f'"hello":{self._hello},"frame":{self._pictures.frame(self._pictures.next_piece)},'
                f'"needles":{encode(needles_picture(self._needles))},'
                f'"traces":{self._pictures.traces(0)},"notices":[{",".join(self._notices)}],'
                f'"audit":[{",".join(self._done)}],"plans":{self._plans},"proposals":{self._proposals},"live":{self._live_picture()},"finished":[{",".join(self._finished)}],'
                f'"figures":{self._figures},"campaign":{self._campaign}'
            )
        return f'{snapshot[:-1]},{self._common},"desk":{desk}}}'

    def _live_picture(self) -> str:
        return encode([asdict(outlet) for outlet in self._live.values()])

    def _begin(self, hello: Hello) -> None:
        self._hello, self._connected = encode(hello_picture(hello)), True
        for client in self.clients.values():
            client.fall_behind()
        self._changed()

    def _changed(self) -> None:
        self._common = ""
        self.news.set()

    def _tell(self, text: str) -> None:
        for client in self.clients.values():
            client.offer(text)
        self._changed()

    def _desk(self, client: Client) -> str:
        holder, role = str(self.desk.seen_from(client.session)), client.who.visitor.role
        count = len(self.clients)
        return encode({"type": "desk", "holder": holder, "browsers": count, "role": role})

    def _notice(self, notice: Notice) -> None:
        if notice.kind == WRITTEN:
            self._written(notice)
            return
        self.add_notice(notice)
        if notice.outcome is not None:
            self._needles = notice.needles or self._needles
            folder = str(notice.folder or "")
            picture = outcome_picture(
                notice.outcome, notice.needles, notice.plan, folder, self._utc()
            )
            entry = encode(picture)
            self._finished.append(entry)
            self._tell(f'{{"type":"finished","entry":{entry}}}')
