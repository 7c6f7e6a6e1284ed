# SPDX-License-Identifier: Apache-2.0
"""The files that the rules look at."""

SOURCE_FOLDERS = ("adapters", "gateway", "tests", "deploy", "schemas")
CODE = {".cpp", ".hpp", ".py", ".cmake"}


def files(root, suffixes):
    """All files of the repository with these suffixes, as paths relative to its root."""
    for folder in SOURCE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and path.suffix in suffixes and "__pycache__" not in path.parts:
                yield path.relative_to(root).as_posix()


def lines(root, name):
    return enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1)
