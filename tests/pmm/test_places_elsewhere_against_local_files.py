"""What lies elsewhere gives what the same files give here: in memory, and in S3 where it is."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fsspec
import pytest
from click.testing import CliRunner

import pmm
from benchmarks.campaign_folder import make_campaign
from hardware.description.errors import ConfigurationError, DataError
from pmm.cli import cli
from pmm.parallel import task_folder
from pmm.remote import local_path, url_of

RUNS = 2


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_campaign(tmp_path_factory.mktemp("campaign"), RUNS, 12.0)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture(params=["memory", pytest.param("s3", marks=pytest.mark.slow)], scope="module")
def system(request: pytest.FixtureRequest) -> Iterator[tuple[Any, str]]:
    """A system of files elsewhere, and the URL of an empty folder or bucket there."""
    if request.param == "memory":
        yield fsspec.filesystem("memory"), "memory://bucket"
        return
    pytest.importorskip("s3fs", reason="optional dependency s3")
    moto = pytest.importorskip("moto.server", reason="no moto[server]")
    server = moto.ThreadedMotoServer("127.0.0.1", 0, verbose=False)
    server.start()
    try:
        host, port = server.get_host_and_port()
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
            patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
            for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
                patch.setenv(name, "any")
            files = fsspec.filesystem("s3")
            files.mkdir("bucket")
            yield files, "s3://bucket"
    finally:
        server.stop()


@pytest.fixture
def there(system: tuple[Any, str], folder: Path) -> Iterator[str]:
    files, url = system
    files.put(f"{folder}/", f"{url}/campaign/", recursive=True)
    yield f"{url}/campaign"
    files.rm(f"{url}/campaign", recursive=True)


def _json(*words: str, status: int = 0) -> dict[str, Any]:
    result = CliRunner().invoke(cli, [*words, "--json"], catch_exceptions=False)
    assert result.exit_code == status, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def test_commands_and_python_tell_of_it_what_they_tell_of_its_files(
    there: str, folder: Path
) -> None:
    mine, theirs = (
        _json("analyse", f"{place}/run-0001.nc")["runs"] for place in (str(folder), there)
    )
    assert [one["gates"] for one in theirs] == [one["gates"] for one in mine]
    own, other = (pmm.open(place).harmonics().to_dataframe() for place in (str(folder), there))
    assert other.equals(own)
    own, other = (
        _json("compare", f"{place}/run-0001.nc:displacement_aft", ":displacement_fore")["gain"]
        for place in (str(folder), there)
    )
    assert other == own


@pytest.mark.slow
def test_an_archive_holds_what_it_holds_of_the_folder_and_sees_changes_there(
    there: str, system: tuple[Any, str], folder: Path, tmp_path: Path
) -> None:
    hashes = {}
    for name, place in {"mine": str(folder), "theirs": there}.items():
        file = str(tmp_path / f"{name}.sqlite")
        _json("archive", "add", place, "--analyse", "--archive", file)
        [row] = _json("archive", "list", "--archive", file)["campaigns"]
        hashes[name] = row["sha256"]
        assert row["analysed"]
        assert not row["changes"]
    assert hashes["theirs"] == hashes["mine"]
    system[0].pipe(f"{there}/run-0000.nc", b"other")
    [row] = _json("archive", "list", "--archive", file)["campaigns"]
    assert row["changes"] == ["run-0000.nc changed"]
    system[0].rm(f"{there}/run-0000.nc")
    [row] = _json("archive", "list", "--archive", file)["campaigns"]
    assert row["changes"] == ["run-0000.nc vanished"]


def test_only_what_changed_is_copied_again(
    there: str, system: tuple[Any, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    copied: list[str] = []
    files = system[0]
    get = files.get_file

    def noted(one: str, *args: Any, **options: Any) -> Any:
        copied.append(Path(one).name)
        return get(one, *args, **options)

    monkeypatch.setattr(files, "get_file", noted)
    target = local_path(there)
    assert sorted(copied) == ["campaign.toml", "run-0000.nc", "run-0001.nc"]
    copied.clear()
    assert local_path(there) == target
    assert not copied
    system[0].pipe(f"{there}/campaign.toml", b"name = 'a longer one'")
    assert local_path(there) == target
    assert copied == ["campaign.toml"]
    assert (target / "campaign.toml").read_bytes() == b"name = 'a longer one'"


def test_a_worker_of_another_computer_makes_its_own_copy_of_the_path_that_it_is_sent(
    there: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent = local_path(there)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "another"))
    mine = task_folder(sent)
    assert mine.is_relative_to(tmp_path / "another")
    assert {one.name: one.read_bytes() for one in mine.iterdir()} == {
        one.name: one.read_bytes() for one in sent.iterdir()
    }
    assert url_of(sent) == url_of(mine) == there


@pytest.mark.parametrize(
    ("url", "error", "message"),
    [
        ("memory://nothing/there.nc", ConfigurationError, "^memory://nothing/there.nc: no such"),
        ("memory://bucket/../secret", DataError, r"^memory://bucket/\.\./secret: .*'\.\.' in it"),
        ("sevenz3://bucket/run.nc", ConfigurationError, "^sevenz3://bucket/run.nc: .*sevenz3"),
        (
            "http://127.0.0.1:9/run.nc",
            DataError,
            "^http://127.0.0.1:9/run.nc: cannot be read: ",
        ),
    ],
)
def test_what_cannot_be_had_is_said_with_its_url(
    url: str, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        local_path(url)


def test_plain_paths_and_files_by_url_are_themselves(folder: Path) -> None:
    assert local_path(folder) == folder
    assert local_path(str(folder)) == folder
    assert local_path("run.nc:channel") == Path("run.nc:channel")
    assert local_path(f"file://{folder}") == folder


def test_nothing_is_written_elsewhere(there: str, tmp_path: Path) -> None:
    told = CliRunner().invoke(cli, ["archive", "add", there, "--archive", f"{there}/a.sqlite"])
    assert told.exit_code == 2
    assert "only a folder of this computer is written to" in told.stderr
    file = str(tmp_path / "a.sqlite")
    _json("archive", "add", there, "--archive", file)
    told = CliRunner().invoke(cli, ["archive", "note", "run-0000", "seen", "--archive", file])
    assert told.exit_code == 2
    assert f"{there}: what lies elsewhere is only read" in told.stderr
