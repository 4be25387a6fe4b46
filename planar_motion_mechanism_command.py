"""The entrance of the command ``pmm``."""

import sys

from planar_motion_mechanism import refuse_intruders


def main() -> None:
    """Run the command line, or say in one sentence which package is not ours."""
    try:
        refuse_intruders()
    except ImportError as error:
        sys.exit(f"Error: {error}")
    from pmm.cli import main as run

    run()


if __name__ == "__main__":
    main()
