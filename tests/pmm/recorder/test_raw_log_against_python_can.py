"""What python-can reads in a raw log is what was observed; what is cut off leaves the beginning."""

import can
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.line_log import LoggedPort
from hardware.playback import PlaybackBus
from hardware.raw_log import CONTAINER_BYTES, FramePacker, container, file_header
from hardware.raw_log_reading import look, read_frames

FRAMES = st.builds(
    can.Message,
    timestamp=st.floats(0.0, 2e9),
    arbitration_id=st.integers(0, 0x7FF),
    is_extended_id=st.booleans(),
    is_rx=st.booleans(),
    data=st.binary(max_size=8),
) | st.builds(
    can.Message,
    is_error_frame=st.just(True),
    arbitration_id=st.integers(0, 0x7FF),
    is_extended_id=st.just(False),
    data=st.binary(min_size=8, max_size=8),
)


def written(path, frames) -> bytes:
    """A log of these frames, drained after every hundred."""
    packer, data = FramePacker(), file_header()
    for at in range(0, len(frames), 100):
        for frame in frames[at : at + 100]:
            packer.take(frame)
        data += b"".join(container(piece) for piece in packer.drain())
    path.write_bytes(data)
    return data


def said(frame: can.Message) -> tuple:
    return (
        frame.arbitration_id,
        bytes(frame.data),
        frame.is_extended_id,
        frame.is_error_frame or frame.is_rx,
        frame.is_remote_frame,
        frame.is_error_frame,
    )


@given(frames=st.lists(FRAMES, max_size=30))
def test_python_can_reads_what_was_observed(tmp_path_factory, frames: list[can.Message]) -> None:
    path = tmp_path_factory.mktemp("log") / "bus.blf"
    written(path, frames)
    with can.BLFReader(path) as log:
        found = list(log)
    assert [said(one) for one in found] == [said(one) for one in frames]
    own = list(read_frames(path))
    assert [said(one) for one in own] == [said(one) for one in found]
    assert [one.dlc for one in own] == [one.dlc for one in found]
    assert [one.timestamp for one in own] == pytest.approx([one.timestamp for one in found])
    stamps = [one.timestamp for one in found]
    assert stamps == sorted(stamps)
    latest = max((one.timestamp for one in frames), default=0.0)
    assert not stamps or stamps[-1] == pytest.approx(latest, abs=1e-6)
    state = look(path)
    assert (state.frames, state.tail_bytes) == (len(frames), 0)


def numbered(count: int) -> list[can.Message]:
    return [
        can.Message(timestamp=i * 1e-3, arbitration_id=0x181, data=i.to_bytes(8, "little"),
                    is_extended_id=False)
        for i in range(count)
    ]  # fmt: skip


@given(share=st.floats(0.0, 1.0))
def test_a_log_cut_anywhere_is_its_beginning(tmp_path_factory, share: float) -> None:
    path = tmp_path_factory.mktemp("log") / "bus.blf"
    data = written(path, numbered(500))
    path.write_bytes(data[: round(share * len(data))])
    numbers = [int.from_bytes(one.data, "little") for one in read_frames(path)]
    assert numbers == list(range(len(numbers)))
    state = look(path)
    assert state.frames in (0, 100, 200, 300, 400, 500)
    assert state.frames <= len(numbers)
    assert 0 <= state.tail_bytes <= path.stat().st_size


def test_containers_stay_small() -> None:
    packer = FramePacker()
    for frame in numbered(1000):
        packer.take(frame)
    pieces = packer.drain()
    assert max(map(len, pieces)) <= CONTAINER_BYTES
    assert sum(map(len, pieces)) == packer.unpacked_bytes == 48_000
    assert packer.drain() == []


def test_the_head_of_a_closed_log_says_size_and_count(tmp_path) -> None:
    path = tmp_path / "bus.blf"
    data = written(path, numbered(10))
    path.write_bytes(file_header(len(data), 480, 10) + data[144:])
    with can.BLFReader(path) as log:
        assert (log.file_size, log.uncompressed_size, log.object_count) == (len(data), 480, 10)
        assert len(list(log)) == 10


def sync(number: int, *, sent: bool = True) -> can.Message:
    return can.Message(arbitration_id=0x80, data=[number], is_extended_id=False, is_rx=not sent)


def test_playback_releases_a_cycle_with_each_sync(tmp_path) -> None:
    path = tmp_path / "bus.blf"
    answers = numbered(4)
    before = can.Message(arbitration_id=0x701, data=[5], is_extended_id=False)
    written(path, [before, sync(7), answers[0], answers[1], sync(8), sync(9), answers[2]])
    with PlaybackBus(str(path)) as bus:
        assert bus.recv(0.0) is None
        bus.send(can.Message(arbitration_id=0x201, data=[7], is_extended_id=False))
        assert bus.recv(0.0) is None
        bus.send(sync(7))
        assert [bus.recv(0.0).data for _ in range(2)] == [one.data for one in answers[:2]]
        assert bus.recv(0.0) is None
        bus.send(sync(240))  # one that the lost bus of the run did not carry
        assert bus.recv(0.0) is None
        bus.send(sync(8))
        assert bus.recv(0.0) is None
        assert not bus.at_end
        bus.send(sync(9))
        assert bus.recv(0.0).data == answers[2].data
        assert bus.at_end


def test_logged_lines_come_in_their_cycles() -> None:
    now = iter([1, 2, 3, 3, 3, 4, 5, 5, 6])
    port = LoggedPort([(3, b"a"), (3, b"b"), (5, b"c")], lambda: next(now))
    assert [port.lines() for _ in range(5)] == [[], [], [b"a", b"b"], [], [b"c"]]
    assert port.lines() == []
