"""The console's HTTP in OpenAPI 3.1: made from the models that hold what is posted."""

from typing import Any, Final

from pydantic.json_schema import models_json_schema

from hardware.description.version import program
from pmm.console.requests import (
    AnswerPosted,
    CommandPosted,
    DecisionPosted,
    DropPosted,
    EditPosted,
    GivePosted,
    HoldPosted,
    MovePosted,
    NotePosted,
    PlanPosted,
    Posted,
    TakePosted,
    TokenPosted,
)

# What is posted where, what it does, and whether it takes control.
POSTS: Final[dict[str, tuple[type[Posted], str, bool]]] = {
    "/login": (TokenPosted, "Give the token, and a name for the log, and get a cookie.", False),
    "/api/command": (CommandPosted, "Command run control; a quick stop needs no control.", True),
    "/api/answer": (AnswerPosted, "Answer the rig's question.", True),
    "/api/take-control": (TakePosted, "Take control.", False),
    "/api/give-control": (GivePosted, "Give control back, for whoever takes it next.", True),
    "/api/plans/check": (PlanPosted, "Read and check a plan; nothing is changed.", False),
    "/api/plans/queue": (PlanPosted, "Queue a plan.", True),
    "/api/plans/drop": (DropPosted, "Take a plan out of the queue.", True),
    "/api/plans/edit": (EditPosted, "Change the settings of a run that is planned.", True),
    "/api/plans/move": (MovePosted, "Move a run that is planned, or a plan that waits.", True),
    "/api/plans/hold": (HoldPosted, "Pass a run or a plan over, or release it.", True),
    "/api/proposals/approve": (DecisionPosted, "Carry out what is proposed.", True),
    "/api/proposals/refuse": (DecisionPosted, "Refuse or withdraw what is proposed.", False),
    "/api/plans/note": (NotePosted, "Keep a line on a run or a campaign.", False),
}
GETS: Final = {
    "/api/plans": ("Names of the plans that are offered.", "names"),
    "/api/pages": ("Pages and figures in the campaigns' folders.", "pages"),
    "/api/audit": ("Who did what with the present campaign, the latest last.", "audit"),
    "/api/openapi.json": ("This description.", "openapi"),
}
_REFUSALS: Final = {
    "401": "a token is needed, or it is wrong",
    "403": "a foreign origin, or no control",
    "409": "the rig, the plan or the folders do not allow it; the text says why",
    "421": "the console is called by a foreign name",
    "422": "no such body",
    "429": "too many wrong tokens; wait",
}
_MODEL: Final = "#/components/schemas/{model}"


def description() -> dict[str, Any]:
    """Return the description: paths, bodies, answers."""
    models = [(model, "validation") for model in {model for model, *_ in POSTS.values()}]
    _, schemas = models_json_schema(
        sorted(models, key=lambda pair: pair[0].__name__),  # type: ignore[arg-type]
        ref_template=_MODEL,
    )
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "Console of a planar motion mechanism",
            "version": program().split()[-1],
            "description": "Requests that act carry the console's own origin, and the session that "
            "the stream's snapshot has told. Live values come over the WebSocket /stream. "
            "What whoever has the token for proposing posts about the queue is kept as a proposal.",
        },
        "paths": {
            **{path: {"post": _post(*about)} for path, about in POSTS.items()},
            **{path: {"get": _get(*about)} for path, about in GETS.items()},
        },
        "components": {
            "schemas": {
                **schemas["$defs"],
                "Taken": _object(
                    said=_text("what happened"), plan={"type": "object"}, number={"type": "integer"}
                ),
                "Refused": _object(error=_text("why not, in a sentence")),
            },
            "securitySchemes": {
                "cookie": {"type": "apiKey", "in": "cookie", "name": "pmm-console"}
            },
        },
        "security": [{"cookie": []}, {}],
    }


def _post(model: type[Posted], does: str, needs_control: bool) -> dict[str, Any]:
    session = {"name": "x-pmm-session", "in": "header", "required": needs_control,
               "schema": {"type": "string"}}  # fmt: skip
    origin = {"name": "origin", "in": "header", "required": True, "schema": {"type": "string"}}
    reference = {"$ref": _MODEL.format(model=model.__name__)}
    return {
        "summary": does,
        "parameters": [origin, session],
        "requestBody": {"required": True, "content": {"application/json": {"schema": reference}}},
        "responses": {"200": _answer("done", "Taken"), **_refusals()},
    }


def _get(does: str, key: str) -> dict[str, Any]:
    content = {"application/json": {"schema": {"type": "object", "required": [key]}}}
    refused = {
        code: refusal for code, refusal in _refusals().items() if code in ("401", "409", "421")
    }
    answer = {"description": does, "content": content}
    return {"summary": does, "responses": {"200": answer, **refused}}


def _refusals() -> dict[str, Any]:
    return {code: _answer(text, "Refused") for code, text in _REFUSALS.items()}


def _answer(text: str, model: str) -> dict[str, Any]:
    schema = {"$ref": _MODEL.format(model=model)}
    return {"description": text, "content": {"application/json": {"schema": schema}}}


def _object(**properties: dict[str, str]) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


def _text(about: str) -> dict[str, str]:
    return {"type": "string", "description": about}
