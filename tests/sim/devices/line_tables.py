"""Lines of a drive panel for tests: everything that a table of them can say."""

from typing import Any

PANEL: dict[str, Any] = {
    "driver": "line-carriage",
    "highest_speed_m_s": 3.0,
    "acceleration_m_s2": 0.5,
    "tolerance_m_s": 0.01,
    "settle_s": 0.5,
    "track_m": [0.0, 60.0],
    "return_speed_m_s": 1.5,
    "lines": {
        "set_speed": {"line": "SP{value:+.2f}", "answer": "OK", "unit": "mm/s", "scale": -1.0},
        "speed": {"line": "RS", "answer": "V = {value} m/min", "unit": "m/min"},
        "position": {"line": "RP", "answer": "P{value}", "unit": "mm"},
        "status": {
            "line": "ST", "answer": "S:",
            "remote": "REM", "ready": "RDY", "alarm": "FLT", "at_end": "LIM",
        },
        "command": {"on": "EN", "off": "DI", "clear": "CL", "answer": "OK"},
    },
}  # fmt: skip
