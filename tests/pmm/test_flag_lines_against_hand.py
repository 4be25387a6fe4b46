"""Equal flags are one line: counted, with every run and channel; no flag is lost."""

from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from hardware.description.flags import Flag, Severity
from pmm.document.flag_lines import flag_lines


def repaired(run: str, channel: str, samples: int) -> Flag:
    text = f"{samples} missing sample(s) in runs of up to 3 were filled"
    return Flag("repaired", Severity.WARNING, text, channel, (run,))


def test_thirty_equal_ones_are_one_line_with_a_count() -> None:
    runs = [f"heave-{n}" for n in range(6)]
    flags = [repaired(run, channel, 1 + n % 2) for n, run in enumerate(runs) for channel in "abcde"]
    (line,) = flag_lines(flags)
    assert line.count == 30
    assert line.text == (
        "heave-0, heave-1, heave-2, heave-3, heave-4, heave-5; a, b, c, d, e: 1 missing sample(s) "
        "in runs of up to 3 were filled (30 times; the numbers are those of the first)"
    )


def test_names_in_messages_make_no_difference_and_words_do() -> None:
    def small(name: str, what: str) -> Flag:
        text = f"{name} is 5 % of the load: an error in {what}"
        return Flag("digits_lost", Severity.WARNING, text, name, ("one",))

    lines = flag_lines([small("Z_w", "phase"), small("M_q", "phase"), small("Z_wdot", "gain")])
    assert [line.count for line in lines] == [2, 1]
    assert lines[0].where == "one; Z_w, M_q"
    assert lines[0].text.endswith("(2 times)")  # and their numbers are the same


def test_a_single_flag_says_where_once() -> None:
    (line,) = flag_lines([Flag("gap", Severity.VOID, "force_aft: 31 are missing", "force_aft")])
    assert line.text == "force_aft: 31 are missing"


FLAGS = st.lists(
    st.builds(
        Flag,
        st.sampled_from(("gap", "repaired")),
        st.sampled_from(Severity),
        st.sampled_from(("3 samples", "17 samples", "something else")),
        st.sampled_from((None, "force_aft", "shaft_angle")),
        st.sampled_from(((), ("heave-1",), ("heave-1", "pitch-2"))),
    ),
    max_size=30,
)


@given(FLAGS)
def test_none_is_lost_and_the_gravest_come_first(flags: Sequence[Flag]) -> None:
    lines = flag_lines(flags)
    assert sum(line.count for line in lines) == len(set(flags))
    order = [Severity.VOID, Severity.WARNING, Severity.NOTE]
    ranks = [order.index(line.severity) for line in lines]
    assert ranks == sorted(ranks)
    for flag in flags:
        of_kind = [
            line for line in lines if (line.code, line.severity) == (flag.code, flag.severity)
        ]
        assert any(
            all(run in line.where for run in flag.runs) and (flag.channel or "") in line.where
            for line in of_kind
        )


@given(FLAGS)
def test_a_flag_comes_back_from_a_file(flags: Sequence[Flag]) -> None:
    import json
    from dataclasses import asdict

    told = json.loads(json.dumps([asdict(flag) for flag in flags]))
    assert list(map(Flag.read, told)) == list(flags)
