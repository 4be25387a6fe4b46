"""``pmm archive`` on two simulated campaigns: what was put in, what files hold, what changed."""

import hashlib
import json
import os
import shutil
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

import pmm
from hardware.description.errors import ConfigurationError, DataError
from pmm.archive.database import open_archive
from pmm.archive.notebook import NoteLine, read_notes, write_note
from pmm.archive.queries import campaigns
from pmm.archive.results import AnalysedCampaign, Analyses, GapVerdict
from pmm.cli import cli
from tests.pmm.archive.one_folder import add_folder
from tests.pmm.coefficients.campaigns import vertical_campaign

NOW = "2026-01-01T00:00:00+00:00"
MARCH = 1_741_000_000  # 2025-03-03
SEPTEMBER = 1_757_000_000  # 2025-09-04


def job(*words: object, status: int = 0) -> Result:
    done = CliRunner().invoke(cli, ["archive", *map(str, words)], catch_exceptions=False)
    assert done.exit_code == status, done.output
    return done


def told(*words: object, status: int = 0) -> Any:
    return json.loads(job(*words, "--json", status=status).stdout)


def _date(folder: Path, time_s: float) -> None:
    for path in folder.iterdir():
        os.utime(path, (time_s, time_s))


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two campaigns of a day in March and one in September, the second of a named model."""
    place = tmp_path_factory.mktemp("tank")
    vertical_campaign(place / "march", name="march")
    vertical_campaign(place / "september", (0.7, 1.1), name="september")
    file = place / "september" / "campaign.toml"
    file.write_text('model_name = "KVLCC2"\n' + file.read_text(encoding="utf-8"), encoding="utf-8")
    _date(place / "march", MARCH)
    _date(place / "september", SEPTEMBER)
    return place


@pytest.fixture(scope="module")
def file(tank: Path) -> Path:
    path = tank / "archive.sqlite"
    done = told("add", tank / "march", tank / "september", "--analyse", "--archive", path)
    assert [one["computed"] for one in done["added"]] == [["analysis"]] * 2
    return path


@pytest.fixture
def copy(tank: Path, file: Path, tmp_path: Path) -> Path:
    """The same folders and archive elsewhere, to be changed."""
    for one in ("march", "september"):
        shutil.copytree(tank / one, tmp_path / one)
    told("add", tmp_path / "march", tmp_path / "september", "--archive", tmp_path / "a.sqlite")
    return tmp_path


def _found(file: Path, expression: str, *more: object) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = told("find", expression, *more, "--archive", file)["runs"]
    return rows


def _names(file: Path, expression: str, *more: object) -> set[str]:
    return {one["run"] for one in _found(file, expression, *more)}


QUESTIONS = {
    "hull = 'KVLCC2' and frequency_hz > 0.9": {"one-1.1-20", "two-1.1-20"},
    "hull = '' and not frequency_hz > 0.7": {"one-0.6-20", "two-0.6-20"},
    "strut_phase_rad > 3 and recorded_utc < '2025-06'": {"two-0.6-20", "two-0.9-20"},
    "campaign = 'september' or frequency_hz = 0.9": {
        "one-0.7-20", "two-0.7-20", "one-1.1-20", "two-1.1-20", "one-0.9-20", "two-0.9-20",
    },
    "medium = 'air'": set(),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("question", QUESTIONS)
def test_runs_are_found_by_what_they_were_set_to(file: Path, question: str) -> None:
    assert _names(file, question) == QUESTIONS[question]


@pytest.mark.slow
def test_campaigns_are_listed_as_they_are(file: Path, tank: Path) -> None:
    first, second = told("list", "--archive", file)["campaigns"]
    assert (first["folder"], first["hull"], second["hull"]) == (str(tank / "march"), "", "KVLCC2")
    for one, day in ((first, "2025-03-03"), (second, "2025-09-04")):
        assert (one["runs"], one["recorded"]) == (4, 4)
        assert one["analysed"]
        assert not one["diagnosed"]
        assert one["recorded_utc"].startswith(day)
        assert one["changes"] == []


@pytest.mark.slow
def test_a_run_has_its_recordings_hash(file: Path, tank: Path) -> None:
    run = told("show", "one-0.6-20", "--archive", file)["run"]
    recording = tank / "march" / run["recording"]
    assert run["sha256"] == hashlib.sha256(recording.read_bytes()).hexdigest()
    assert run["eccentricity_m"] == 0.02


@pytest.mark.slow
def test_harmonics_are_those_of_the_recording(file: Path, tank: Path) -> None:
    """Read again from the one file, not from its campaign."""
    frame = pmm.open(tank / "march" / "one-0.6-20.nc").harmonics().to_dataframe()
    values = frame.set_index(["gate", "channel", "order"]).to_dict("index")
    rows = told("show", "one-0.6-20", "--archive", file)["harmonics"]
    assert len(rows) == len(values)
    for row in rows:
        one = values[row["gate"], row["channel"], row["order"]]
        assert row["in_phase"] == pytest.approx(one["in_phase"], rel=1e-12)
        assert row["in_phase_half_width"] == pytest.approx(one["in_phase_half_width"], rel=1e-12)


@pytest.mark.slow
def test_runs_are_found_by_their_harmonics(file: Path) -> None:
    every = _found(file, "kind = 'oscillation'", "--channel", "force_aft")
    size = {one["run"]: (one["in_phase"] ** 2 + one["quadrature"] ** 2) ** 0.5 for one in every}
    limit = sorted(size.values())[4]
    large = _names(file, f"amplitude > {limit!r}", "--channel", "force_aft")
    assert large == {run for run, one in size.items() if one > limit}
    done = job("find", "repeat = 1", "--channel", "force_aff", "--archive", file, status=2)
    assert "no channel 'force_aff'; did you mean 'force_aft'?" in done.stderr


@pytest.mark.slow
def test_a_trend_has_what_was_put_in(file: Path, tmp_path: Path) -> None:
    damping = vertical_campaign(tmp_path / "rig", (0.6,)).water.damping[0][0]
    found = told("trend", "Z_w", "--archive", file)
    assert [one["campaign"] for one in found["trend"]] == ["march", "september"]
    for one in found["trend"]:
        assert abs(one["value"] + damping) < 3.5 * one["standard_uncertainty"]
        assert 0.0 < one["half_width"] < 0.01 * damping
        assert one["low"] is None
    done = job("trend", "Z_x", "--archive", file, status=1)
    assert "no coefficient 'Z_x'; did you mean 'Z_w'?" in done.stderr


@pytest.mark.slow
def test_coefficients_and_verdicts_are_found(copy: Path, file: Path) -> None:
    every = told("find", "coefficient = 'Z_w'", "--coefficients", "--archive", file)["coefficients"]
    trend = told("trend", "Z_w", "--archive", file)["trend"]
    assert [one["value"] for one in every] == [one["value"] for one in trend]
    least = min(one["value"] for one in every)
    words = f"coefficient = 'Z_w' and value > {least!r}"
    (kept,) = told("find", words, "--coefficients", "--archive", file)["coefficients"]
    assert kept["value"] == max(one["value"] for one in every)
    known = Analyses(None, lambda _: GapVerdict("effect", "coulomb-friction", 0.97))
    with open_archive(copy / "a.sqlite") as connection:
        add_folder(connection, copy / "march", known, NOW)
    rows = _found(copy / "a.sqlite", "answer = 'coulomb-friction' and probability > 0.9")
    assert {one["campaign"] for one in rows} == {"march"}
    assert len(rows) == 4
    for words in (("--coefficients", "--channel", "force_aft"), ("--coefficients",)):
        done = job("find", "value > 0", *words, "--archive", copy / "a.sqlite", status=2)
        assert "ask for one of both" in done.stderr or "nothing is analysed yet" in done.stderr


@pytest.mark.slow
def test_a_repeated_run_is_compared_with_its_past(copy: Path) -> None:
    """The same recording five times, the last one's force made larger in the file by hand."""
    file = copy / "a.sqlite"
    told("add", copy / "march", "--analyse", "--archive", file)
    with open_archive(file) as connection, connection:
        (first,) = connection.execute(
            "SELECT * FROM runs WHERE run = 'one-0.6-20' AND campaign = "
            "(SELECT id FROM campaigns WHERE campaign = 'march')"
        ).fetchall()
        names = [name for name in first.keys() if name != "id"]  # noqa: SIM118
        for n, larger in enumerate((1.001, 0.999, 1.0005, 1.3)):
            row = {**first, "run": f"again-{n}", "recorded_utc": f"2025-04-{n + 1:02d}T00:00:00"}
            added = connection.execute(
                f"INSERT INTO runs ({', '.join(names)}) "  # noqa: S608
                f"VALUES ({', '.join('?' * len(names))})",
                [row[name] for name in names],
            ).lastrowid
            connection.execute(
                "INSERT INTO harmonics SELECT campaign, ?, gate, channel, ord, unit, in_phase * ?, "
                "quadrature * ?, in_phase_half_width, quadrature_half_width FROM harmonics "
                "WHERE run = ?",
                (added, larger, larger, first["id"]),
            )
    rows = told("trend", "force_aft", "--run", "again-3", "--archive", file)["trend"]
    runs = ["one-0.6-20", "again-0", "again-1", "again-2", "again-3"]
    assert [one["run"] for one in rows] == runs * 2
    assert [one["part"] for one in rows] == ["in phase"] * 5 + ["quadrature"] * 5
    assert [one["run"] for one in rows if one["outside"]] == ["again-3"] * 2
    done = job("trend", "force_aff", "--run", "again-3", "--archive", file, status=1)
    assert "no harmonic 1 of 'force_aff'; did you mean 'force_aft'?" in done.stderr


@pytest.mark.slow
def test_parquet_reads_back(file: Path, tmp_path: Path) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "harmonics.parquet"
    job("export", "--parquet", path, "--archive", file)
    table = pq.read_table(path)
    assert table.schema.metadata[b"level"] == b"0.95"
    rows = [one for one in table.to_pylist() if one["channel"] == "force_aft" and one["order"] == 1]
    every = _found(file, "repeat = 1", "--channel", "force_aft")
    keys = ("run", "frequency_hz", "in_phase", "quadrature", "in_phase_half_width", "unit")
    assert [[one[k] for k in keys] for one in rows] == [[one[k] for k in keys] for one in every]
    done = job("export", "--parquet", path, "--archive", file, status=2)
    assert "there already" in done.stderr
    job("export", "--parquet", path, "--coefficients", "--overwrite", "--archive", file)
    every = told("find", "coefficient != ''", "--coefficients", "--archive", file)["coefficients"]
    assert pq.read_table(path).to_pylist() == every


def _answers(file: Path) -> list[Any]:
    run = ("one-0.6-20", "two-1.1-20")
    return [
        told("list", "--archive", file),
        *(told("show", one, "--archive", file) for one in run),
        told("find", "frequency_hz > 0", "--channel", "force_fore", "--archive", file),
        told("trend", "M_q", "--archive", file),
    ]


@pytest.mark.slow
def test_made_again_from_the_folders_it_answers_the_same(copy: Path) -> None:
    file, folders = copy / "a.sqlite", (copy / "march", copy / "september")
    told("add", *folders, "--analyse", "--archive", file)
    job("note", "one-0.6-20", "gauge fore: Ü 3 N off", "--author", "A. B.", "--archive", file)
    before = _answers(file)
    (note,) = before[1]["notes"]
    assert (note["author"], note["text"]) == ("A. B.", "gauge fore: Ü 3 N off")
    assert before[0]["campaigns"][0]["changes"] == []
    file.unlink()
    told("add", *folders, "--analyse", "--archive", file)
    assert _answers(file) == before


@pytest.mark.slow
def test_what_is_known_is_not_computed_again(copy: Path) -> None:
    calls = []

    def analyse(folder: Path) -> AnalysedCampaign:
        calls.append(folder.name)
        return AnalysedCampaign(refused=("one: no gate",))

    wanted = Analyses(analyse, lambda _: GapVerdict("effect", "m1", 0.9))
    with open_archive(copy / "a.sqlite") as connection:

        def add() -> tuple[str, tuple[str, ...]]:
            done = add_folder(connection, copy / "march", wanted, NOW)
            return done.state, done.computed

        assert add() == ("as before", ("analysis", "diagnosis"))
        first, _ = campaigns(connection)
        assert (first["verdict"], first["answer"], first["probability"]) == ("effect", "m1", 0.9)
        assert first["refused"] == ["one: no gate"]
        assert add() == ("as before", ())
        (copy / "march" / "one-0.6-20.nc").touch()
        assert add() == ("as before", ())
        (copy / "march" / "coefficients.toml").write_text('system = "prime"\n', encoding="utf-8")
        assert add() == ("changed", ("analysis", "diagnosis"))
    assert calls == ["march"] * 2


@pytest.mark.slow
def test_what_changed_or_vanished_is_said(copy: Path) -> None:
    def changes() -> list[list[str]]:
        return [one["changes"] for one in told("list", "--archive", copy / "a.sqlite")["campaigns"]]

    assert changes() == [[], []]
    (copy / "march" / "one-0.6-20.nc").touch()
    assert changes() == [[], []]
    with (copy / "march" / "one-0.6-20.nc").open("ab") as file:
        file.write(b"\0")
    (copy / "march" / "two-0.6-20.nc").unlink()
    shutil.rmtree(copy / "september")
    assert changes() == [["one-0.6-20.nc changed", "two-0.6-20.nc vanished"],
                         ["the folder vanished"]]  # fmt: skip
    words = " ".join(job("list", "--archive", copy / "a.sqlite").stdout.split())
    assert "not analysed" in words
    assert "two-0.6-20.nc vanished; what is told is of before" in words
    done = job("note", "one-0.7-20", "lost", "--archive", copy / "a.sqlite", status=1)
    assert "the folder vanished" in done.stderr
    (added,) = told("add", copy / "march", "--archive", copy / "a.sqlite")["added"]
    assert added["state"] == "changed"
    assert changes()[0] == []


@pytest.mark.slow
def test_a_folder_that_changes_while_it_is_analysed_is_refused(copy: Path) -> None:
    def analyse(folder: Path) -> AnalysedCampaign:
        (folder / "one-0.6-20.nc").unlink()
        return AnalysedCampaign()

    with (
        open_archive(copy / "a.sqlite") as connection,
        pytest.raises(DataError, match=r"one-0\.6-20\.nc vanished while it was analysed"),
    ):
        add_folder(connection, copy / "march", Analyses(analyse), NOW)


@pytest.mark.slow
def test_bad_requests_are_said(copy: Path, tmp_path: Path) -> None:
    none = tmp_path / "none.sqlite"
    assert "no archive; make one with" in job("list", "--archive", none, status=2).stderr
    assert not none.exists()
    text = tmp_path / "text.sqlite"
    text.write_text("no database, but text that is long enough to be looked at\n" * 20)
    assert "not a database" in job("list", "--archive", text, status=2).stderr
    file = copy / "a.sqlite"
    done = job("add", copy, copy / "march", "--archive", file, status=2)
    assert "no folder with a campaign.toml" in done.stderr
    assert "march" in done.stdout
    shutil.copytree(copy / "march", copy / "again")
    with (copy / "again" / "campaign.toml").open("a", encoding="utf-8") as text_file:
        text_file.write("# of another week\n")
    told("add", copy / "again", "--archive", file)
    told("add", copy / "again", "--archive", copy / "not" / "yet" / "there.sqlite")
    done = job("show", "one-0.6-20", "--archive", file, status=2)
    assert "several runs 'one-0.6-20'; say which with --campaign" in done.stderr
    job("show", "one-0.6-20", "--campaign", copy / "again", "--archive", file)
    done = job("show", "one-0.6", "--archive", file, status=2)
    assert "no run 'one-0.6'; did you mean 'one-0.6-20'?" in done.stderr


def test_notes_are_lines(tmp_path: Path) -> None:
    note = NoteLine(NOW, "run", "me", "one")
    write_note(tmp_path, note)
    path = tmp_path / "notes.jsonl"
    path.write_bytes(path.read_bytes().rstrip(b"\n"))  # as an editor may leave it
    write_note(tmp_path, note)
    assert read_notes(tmp_path) == (note, note)
    for text in ("", " ", "two\nlines"):
        with pytest.raises(ConfigurationError, match="one line of printable text"):
            write_note(tmp_path, NoteLine(NOW, "run", "me", text))
    path.write_text(path.read_text(encoding="utf-8") + '{"time_utc": 3}\n', encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"notes\.jsonl:3: no note"):
        read_notes(tmp_path)


@pytest.mark.slow
def test_a_campaign_outside_is_said_and_marked(tmp_path: Path) -> None:
    file = tmp_path / "archive.sqlite"
    with open_archive(file, create=True) as connection, connection:
        for n, value in enumerate((-10.0, -10.1, -9.9, -10.05, -13.0, -9.95), 1):
            connection.execute(
                "INSERT INTO campaigns (id, folder, campaign, hull, recorded_utc, seen_utc, "
                "sha256) VALUES (?, ?, ?, 'H', ?, '', '')",
                (n, f"/{n}", f"test-{n}", f"2025-{n:02d}-01T00:00:00+00:00"),
            )
            connection.execute(
                "INSERT INTO coefficients VALUES (?, 'M_q', 'N m s/rad', 1.2, 0, ?, 0.05, 0.1, "
                "0.95)", (n, value),
            )  # fmt: skip
    outside = [one["outside"] for one in told("trend", "M_q", "--archive", file)["trend"]]
    assert outside == [False] * 4 + [True, False]
    plots = tmp_path / "plots"
    words = " ".join(job("trend", "M_q", "--plot", plots, "--archive", file).stdout.split())
    assert "test-5 (2025-05-01): M_q -13 is not within" in words
    assert {one.name for one in plots.iterdir()} == {"archive-trend.svg", "archive-trend.png"}
    assert "outside" in (plots / "archive-trend.svg").read_text(encoding="utf-8")
