"""What the source says about itself: modules, their imports and their public names, read without importing them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

HEAVY = (
    "arviz",
    "corner",
    "distributed",
    "dynesty",
    "emcee",
    "h5py",
    "jinja2",
    "matplotlib",
    "pandas",
    "pint",
    "rich",
    "scipy.stats",
    "xarray",
)
"""Imported inside the functions that use them."""
PACKAGE = ROOT / "skinbayes"

Definition = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


@dataclass(frozen=True)
class Import:
    """One imported module: the importer, the target, and the functions it is imported in (outermost first)."""

    module: str
    target: str
    line: int
    inside: tuple[str, ...]

    @property
    def lazy(self) -> bool:
        return bool(self.inside)

    def __str__(self) -> str:
        place = f" inside {'.'.join(self.inside)}" if self.inside else ""
        return f"{self.module} (line {self.line}){place} imports {self.target}"


@cache
def modules() -> dict[str, Path]:
    """Every module of the package by its dotted name."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def tree_of(module: str) -> ast.Module:
    """The syntax tree of a module."""
    return ast.parse(modules()[module].read_text(encoding="utf-8"), filename=str(modules()[module]))


def floor_of(module: str) -> str:
    """The part of the house a module belongs to: ``contact`` of ``skinbayes.contact.area``; ``skinbayes`` itself."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else parts[0]


def imports_of(module: str) -> list[Import]:
    """Everything a module imports at run time, also inside functions; ``if TYPE_CHECKING`` is left out."""
    return list(_imports(tree_of(module), module, ()))


def all_imports() -> list[Import]:
    """The imports of all modules."""
    return [found for module in modules() for found in imports_of(module)]


def _imports(node: ast.AST, module: str, inside: tuple[str, ...]) -> Iterator[Import]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            for other in child.orelse:
                yield from _imports(other, module, inside)
        elif isinstance(child, ast.Import):
            for alias in child.names:
                yield Import(module, alias.name, child.lineno, inside)
        elif isinstance(child, ast.ImportFrom):
            yield from _from_import(child, module, inside)
        elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            name = getattr(child, "name", "lambda")
            yield from _imports(child, module, (*inside, name))
        elif isinstance(child, ast.ClassDef) and inside == ():
            # a class body runs at import; the name is kept so that methods can be told apart
            for statement in child.body:
                if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
                    yield from _imports(statement, module, (child.name, statement.name))
                else:
                    yield from _imports(ast.Module([statement], []), module, ())
        else:
            yield from _imports(child, module, inside)


def _from_import(node: ast.ImportFrom, module: str, inside: tuple[str, ...]) -> Iterator[Import]:
    base = node.module or ""
    if node.level:
        package = module if modules()[module].name == "__init__.py" else module.rpartition(".")[0]
        for _ in range(node.level - 1):
            package = package.rpartition(".")[0]
        base = f"{package}.{base}".rstrip(".")
    for alias in node.names:
        deeper = f"{base}.{alias.name}"
        # 'from scipy import stats' imports scipy.stats; 'from skinbayes import vocabulary' a module of ours
        is_module = deeper in modules() or (base in ("scipy", "matplotlib") and alias.name.islower())
        yield Import(module, deeper if is_module else base, node.lineno, inside)


def is_public(name: str) -> bool:
    """Tell whether no part of a dotted name begins with an underscore."""
    return not any(part.startswith("_") for part in name.split("."))


def public_definitions(floors: tuple[str, ...]) -> Iterator[tuple[str, Definition]]:
    """Functions, classes, and their public methods and properties, defined in public modules of some floors."""
    for module in modules():
        if floor_of(module) in floors and is_public(module):
            for node in tree_of(module).body:
                yield from _definitions(node, module)


def _is_overload(node: Definition) -> bool:
    """Whether it only states types of the definition that follows."""
    return any(isinstance(one, ast.Name) and one.id == "overload" for one in node.decorator_list)


def _definitions(node: ast.AST, prefix: str) -> Iterator[tuple[str, Definition]]:
    if isinstance(node, Definition) and is_public(node.name) and not _is_overload(node):
        yield f"{prefix}.{node.name}", node
        if isinstance(node, ast.ClassDef):
            for member in node.body:
                yield from _definitions(member, f"{prefix}.{node.name}")
