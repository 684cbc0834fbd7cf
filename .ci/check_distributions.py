"""Check what a wheel and an sdist contain: ``python .ci/check_distributions.py FOLDER``."""

from __future__ import annotations

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path, PurePosixPath


def check_wheel(path: Path, tracked: set[str]) -> list[str]:
    """What is wrong with the wheel: one importable package, with every module, model and data set."""
    names = {name for name in zipfile.ZipFile(path).namelist() if not name.endswith("/")}
    top = {PurePosixPath(name).parts[0] for name in names}
    info = {name for name in top if name.endswith(".dist-info")}
    problems = [f"{path.name}: top level has {', '.join(sorted(top))}"] if top - info != {"skinbayes"} else []
    wanted = {name for name in tracked if name.startswith("skinbayes/")}
    wanted |= {f"skinbayes/_shipped/{name}" for name in tracked if name.startswith(("models/", "datasets/"))}
    inside = {name for name in names if name.startswith("skinbayes/")}
    problems += [f"{path.name}: lacks {name}" for name in sorted(wanted - inside)]
    problems += [f"{path.name}: has {name}, which the tree has not" for name in sorted(inside - wanted)]
    if "skinbayes/py.typed" not in names:
        problems.append(f"{path.name}: lacks py.typed")
    return problems


def check_sdist(path: Path, tracked: set[str]) -> list[str]:
    """What is wrong with the sdist: everything that builds, tests and explains the package."""
    with tarfile.open(path) as archive:
        names = {str(PurePosixPath(*PurePosixPath(m.name).parts[1:])) for m in archive if m.isfile()}
    parts = (
        "skinbayes/",
        "models/",
        "datasets/",
        "tests/",
        "docs/",
        "notebooks/",
        "README.md",
        "LICENSE",
        "pyproject.toml",
    )
    wanted = {name for name in tracked if name.startswith(parts)}
    return [f"{path.name}: lacks {name}" for name in sorted(wanted - names)]


def main() -> None:
    """Print what is wrong and exit with status 1, or say that nothing is."""
    folder = Path(sys.argv[1])
    (wheel,), (sdist,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    listed = subprocess.run(["git", "ls-files"], check=True, capture_output=True, text=True)
    tracked = set(listed.stdout.splitlines())
    problems = check_wheel(wheel, tracked) + check_sdist(sdist, tracked)
    if problems:
        sys.exit("\n".join(problems))
    print(f"{wheel.name} and {sdist.name} are complete")


if __name__ == "__main__":
    main()
