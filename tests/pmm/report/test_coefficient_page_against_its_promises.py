"""The report of a campaign: one file that needs no other, with every number of the table."""

import hashlib
import html
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.archive.notebook import NoteLine, write_note
from pmm.cli import cli
from tests.pmm.coefficients.campaigns import vertical_campaign


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder: Path = tmp_path_factory.mktemp("report") / "c"
    vertical_campaign(folder, (0.6, 0.9), name="a & c")
    (folder / "a <b> & c.csv").write_text(
        "frequency_hz,speed_m_s,Z_w,Z_q\n0.5,1.2,-190,-12\n1,1.2,-210,-12\n"
    )
    reference = 'file = "a <b> & c.csv"\nallowance_relative = 0.01\n'
    settings = f"[uncertainty]\nlag_s = 1e-4\n[[references]]\n{reference}"
    (folder / "coefficients.toml").write_text(settings)
    write_note(folder, NoteLine("2026-01-01T00:00:00+00:00", "", "N. N.", "ballast > 5 kg moved"))
    result = CliRunner().invoke(
        cli, ["report", str(folder), "--uncertainty", "monte-carlo", "--trials", "2000"]
    )
    assert result.exit_code == 0, result.output
    return folder, (folder / "report.html").read_text(encoding="utf-8")


class _Tags(HTMLParser):
    """Counts what is open and collects what a page would load."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loaded: list[tuple[str, str]] = []
        self.ids: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "br", "link", "img"):
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href", "data", "srcset") and not str(value).startswith("#"):
                self.loaded.append((tag, str(value)))
            if name == "id":
                self.ids.append(str(value))

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attributes)
        self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_page_needs_nothing_else(page: tuple[Path, str]) -> None:
    tags = _Tags()
    tags.feed(page[1])
    assert tags.open == []
    assert tags.loaded == []
    assert len(tags.ids) == len(set(tags.ids))
    assert "<script" not in page[1]
    assert "@import" not in page[1]
    assert "default-src 'none'" in page[1]


def test_names_of_users_are_text(page: tuple[Path, str]) -> None:
    assert "<b>" not in page[1].replace("<body>", "")
    assert "a &lt;b&gt; &amp; c" in page[1]


def test_what_was_noted_is_there(page: tuple[Path, str]) -> None:
    notes = page[1].partition("Notes</h2>")[2].partition("<h2")[0]
    for said in ("2026-01-01", "N. N.", "ballast &gt; 5 kg moved"):
        assert said in notes


def test_every_value_and_its_system_is_there(page: tuple[Path, str]) -> None:
    text = html.unescape(re.sub(r"<svg.*?</svg>", "", page[1], flags=re.S))
    for name in ("Z_wdot", "Z_w", "M_wdot", "M_w", "Z_qdot", "Z_q", "M_qdot", "M_q"):
        assert text.count(f'<th scope="row">{name}</th>') >= 6  # two frequencies and zero, twice
    for said in ("Recommended values: dimensional", "linear: dimensional", "Monte Carlo, 2000"):
        assert said in text
    assert text.index("Recommended values") < text.index("<details><summary><h3>Alternatives")
    for source in ("amplifier lag", "moment of inertia", "harmonic scatter"):
        assert source in text


def test_the_reference_stands_beside_the_values(page: tuple[Path, str]) -> None:
    assert "Beside tables from elsewhere" in page[1]
    assert ">within<" in page[1]
    assert 'bad">OUTSIDE<' in page[1]


def test_hashes_and_configuration_are_those_of_the_files(page: tuple[Path, str]) -> None:
    folder, text = page
    for name in ("campaign.toml", "coefficients.toml"):
        content = (folder / name).read_bytes()
        assert hashlib.sha256(content).hexdigest() in text
        assert content.decode() in html.unescape(text)
    for path in folder.glob("*.nc"):
        assert hashlib.sha256(path.read_bytes()).hexdigest()[:16] in text
    assert "numpy" in text


def test_figures_have_axes_units_and_legends(page: tuple[Path, str]) -> None:
    figures = re.findall(r"<svg.*?</svg>", page[1], flags=re.S)
    assert len(figures) == 2
    for said in (
        "frequency (Hz)",
        "(N s/m)",
        "(kg)",
        "linear, 20 mm",
        "recommended",
        "reference",
    ):
        assert said in html.unescape(figures[0])
    for said in (
        "interval of 95 % (% of the value)",
        "share of the variance (%)",
        "harmonic scatter",
        "amplifier lag",
    ):
        assert said in html.unescape(figures[1])


def test_it_is_made_for_paper_too(page: tuple[Path, str]) -> None:
    style = page[1][page[1].index("<style>") : page[1].index("</style>")]
    assert "@media print" in style
    assert "@page" in style


def test_a_page_that_is_there_is_not_lost(page: tuple[Path, str]) -> None:
    result = CliRunner().invoke(cli, ["report", str(page[0])])
    assert result.exit_code == 2
    assert "--overwrite" in result.stderr
