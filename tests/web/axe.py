# SPDX-License-Identifier: Apache-2.0
"""axe-core, which finds what keeps people out of a page: the locked version, from npm, in .deps/axe. It is a tool of the tests and never
shipped. tests/setup fetches it, as a program of its own, where npm is; a test only reads it, and says by name where it is not there."""
import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).absolute().parent
FOLDER = HERE.parent.parent / ".deps/axe"
PATIENCE_S = 120


def wanted():
    lock = json.loads((HERE / "package-lock.json").read_text(encoding="utf-8"))
    return lock["packages"]["node_modules/axe-core"]["version"]


def there():
    package = FOLDER / "node_modules/axe-core/package.json"
    return package.is_file() and json.loads(package.read_text(encoding="utf-8"))["version"] == wanted()


def fetch():
    """Why it cannot be had; empty: it is there."""
    if there():
        return ""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, FOLDER / name)
    try:
        done = subprocess.run(["npm", "ci", "--no-fund", "--no-audit", "--fetch-retries=1", "--fetch-timeout=20000"], cwd=FOLDER, capture_output=True, text=True, check=False,
                              timeout=PATIENCE_S)
    except (OSError, subprocess.TimeoutExpired) as missing:
        return f"npm: {missing}"
    return "" if done.returncode == 0 and there() else (done.stderr or done.stdout).strip()


def axe_core():
    """Its script; None, and said: it is not there."""
    if not there():
        print(f"axe-core {wanted()} is not in .deps/axe (tests/setup fetches it with npm), so nothing was looked at with it", flush=True)
        return None
    return (FOLDER / "node_modules/axe-core/axe.min.js").read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.exit(f"axe-core {wanted()} is not to be had: {reason}" if (reason := fetch()) else 0)
