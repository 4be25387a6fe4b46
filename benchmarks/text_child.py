"""Read a text file in a process of its own, and print what that took as JSON.

``python -m benchmarks.text_child ours PATH``, or ``... arrow PATH``.
"""

import json
import sys
import time

from benchmarks.peak import peak_bytes


def main(who: str, path: str) -> None:
    """Read the file; processor time is that of the whole process."""
    if who == "arrow":
        from pyarrow import csv

        comma = "comma" in path
        csv.read_csv(
            path,
            parse_options=csv.ParseOptions(delimiter=";" if comma else ","),
            convert_options=csv.ConvertOptions(decimal_point="," if comma else "."),
        )
    else:
        from analysis.readers import read_recording

        read_recording(path)
    print(json.dumps({"cpu_s": time.process_time(), "peak_gb": peak_bytes() / 1e9}))


if __name__ == "__main__":
    main(*sys.argv[1:])
