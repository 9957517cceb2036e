"""``python -m camwright`` is the command ``camwright``."""

from camwright.pipeline.cli import main

if __name__ == "__main__":
    main()
