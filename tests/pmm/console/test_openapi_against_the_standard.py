"""The description of the console's HTTP: valid OpenAPI 3.1, and true of what is served."""

from pathlib import Path

import pytest
from openapi_spec_validator import OpenAPIV31SpecValidator, validate
from starlette.routing import Route

from pmm.console.openapi import GETS, POSTS, description
from tests.pmm.console.serving import served

_RIGHT = {
    "/login": {"token": "x"},
    "/api/command": {"command": "hold"},
    "/api/answer": {"question": "?", "answer": "yes"},
    "/api/take-control": {"confirm": True},
    "/api/give-control": {},
    "/api/plans/check": {"name": "plan.toml"},
    "/api/plans/queue": {"name": "plan.toml"},
    "/api/plans/drop": {"number": 1},
    "/api/plans/edit": {"number": 1, "run": "heave-f1", "frequency_hz": 1.1},
    "/api/plans/move": {"number": 1, "run": "heave-f1", "by": -1},
    "/api/plans/hold": {"number": 1, "held": True},
    "/api/proposals/approve": {"number": 1},
    "/api/proposals/refuse": {"number": 1},
    "/api/plans/note": {"number": 1, "text": "calm", "author": "me"},
}


@pytest.mark.slow
def test_it_is_openapi() -> None:
    found = description()
    validate(found, cls=OpenAPIV31SpecValidator)
    assert found["openapi"] == "3.1.0"


def test_it_is_served_and_has_all_that_is_served(tmp_path: Path) -> None:
    with served(tmp_path) as one:
        assert one.browser.get("/api/openapi.json").json() == description()
        app = one.browser.app._app  # type: ignore[attr-defined]
        routes = [route for route in app.router.routes if isinstance(route, Route)]
    posted = {route.path for route in routes if "POST" in (route.methods or ())}
    read = {route.path for route in routes} - posted
    assert posted == set(POSTS)
    assert {path for path in read if path.startswith("/api")} == set(GETS)


@pytest.mark.sample(7)
@pytest.mark.parametrize("path", POSTS)
def test_bodies_are_taken_and_refused_as_it_says(path: str, tmp_path: Path) -> None:
    from jsonschema import Draft202012Validator

    found = description()
    model = POSTS[path][0].__name__
    schema = {**found["components"]["schemas"][model], "components": found["components"]}
    judge = Draft202012Validator(schema)
    wrong = {**_RIGHT[path], "and": 1}
    assert judge.is_valid(_RIGHT[path])
    assert not judge.is_valid(wrong)
    known = found["paths"][path]["post"]["responses"]
    with served(tmp_path) as one:
        for body, status in ((_RIGHT[path], None), (wrong, 422)):
            told, said = one.post(path, body)
            assert str(told) in known
            assert (status is None and told != 422) or told == status
            assert ("error" in said) == (told != 200)
