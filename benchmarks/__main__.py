"""What can be measured: `python -m benchmarks` lists every benchmark with its command and its subject."""

from __future__ import annotations

import ast
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Exit code 0; prints a line for each module that runs by itself."""
    for file in sorted(HERE.rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        own = file.parent == HERE and file.name in ("__init__.py", Path(__file__).name)
        if own or "__main__" not in text:
            continue
        place = file.parent if file.name == "__main__.py" else file.with_suffix("")
        subject = (ast.get_docstring(ast.parse(text)) or "").partition("\n\n")[0].replace("\n", " ")
        name = ".".join(place.relative_to(HERE.parent).parts)
        print(f"python -m {name}\n    {subject.partition(': `python')[0]}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
