"""Register maps of Modbus devices for tests: everything that a map can say, in two ways."""

from typing import Any

CARRIAGE: dict[str, Any] = {
    "driver": "modbus-carriage",
    "highest_speed_m_s": 3.0,
    "acceleration_m_s2": 0.5,
    "tolerance_m_s": 0.01,
    "settle_s": 0.5,
    "track_m": [0.0, 60.0],
    "return_speed_m_s": 1.5,
    "registers": {
        "set_speed": {
            "address": 100, "unit": "mm/s", "type": "int32", "words": "low-first", "scale": 0.1,
        },
        "speed": {"address": 10, "unit": "m/s", "type": "float32", "table": "input"},
        "position": {
            "address": 12, "unit": "mm", "type": "int32", "table": "input", "scale": 0.5,
        },
        "life": {"address": 15, "unit": "1", "type": "uint16", "table": "input"},
        "status": {
            "address": 14, "table": "input", "remote": 0, "ready": 1, "alarm": 2, "at_end": 3,
            "inverted": ["alarm"],
        },
        "command": {"address": 102, "enable": 0, "reset": 1, "toggle": 15},
    },
}  # fmt: skip
DRIFT: dict[str, Any] = {
    "driver": "modbus-axis",
    "low": -0.35,
    "high": 0.35,
    "speed": 0.2,
    "tolerance": 1e-3,
    "standard_uncertainty": 5e-4,
    "settle_s": 0.2,
    "registers": {
        "set_position": {"address": 0, "unit": "deg", "scale": -0.01},
        "position": {"address": 1, "unit": "deg", "scale": -0.01},
        "status": {"address": 2, "remote": 4, "ready": 5},
        "command": {"address": 3, "enable": 0},
    },
}
