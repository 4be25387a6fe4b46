"""Lines of a drive panel for tests: everything that a table of them can say."""

from typing import Any

VOLTAGES: dict[str, Any] = {
    "driver": "analogue-carriage",
    "node": 9,
    "highest_speed_m_s": 3.0,
    "acceleration_m_s2": 0.5,
    "tolerance_m_s": 0.01,
    "settle_s": 0.5,
    "voltages": {
        "set_speed": {"object": "6411:2", "per_volt": -0.4, "offset_v": 0.25},
        "speed": {"object": "6401:1", "per_volt": 0.5, "offset_v": -0.1},
    },
}
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
