"""The command `camwright validate`: page and numbers where asked for, exit code 0."""

import json
import subprocess
import sys
from pathlib import Path

CAMWRIGHT = Path(sys.executable).parent / "camwright"


def test_validate_writes_page_and_numbers(tmp_path):
    done = subprocess.run(
        [CAMWRIGHT, "validate", "--out", str(tmp_path / "new" / "place")],
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "new" / "place"
    document = json.loads((folder / "validation.json").read_text(encoding="utf-8"))
    assert len(document["rows"]) == 62
    assert "62 published values by basis:\n  independent: reproduced " in done.stdout
    text = (folder / "validation.html").read_text(encoding="utf-8")
    assert text.count("<tr ") >= 62
    assert sorted(path.name for path in folder.iterdir()) == ["validation.html", "validation.json"]
