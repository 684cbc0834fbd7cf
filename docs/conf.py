"""How the site is built: ``sphinx-build -W --keep-going -c docs . build/site``.

The source directory is the whole project, so that one link leads to the same place in the repository and on the site.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import skinbayes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "skinbayes"
author = "The skinbayes developers"
copyright = author
version = release = skinbayes.__version__
language = "en"

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
]
root_doc = "docs/index"
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/**", "notebooks/*.ipynb"]
exclude_patterns = [".*", "build", "dist", "skinbayes", "tests", "benchmarks", "datasets", "models", "**.py"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
highlight_language = "text"

# fields of several classes have one name; types in docstrings are words, not references
suppress_warnings = ["ref.python"]

# notebooks are stored without outputs and run when the site is built
nb_execution_mode = "force"
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_execution_show_tb = True

default_role = "literal"
autodoc_typehints = "none"
autodoc_member_order = "alphabetical"
autosummary_generate = False
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
add_module_names = False

html_theme = "pydata_sphinx_theme"
html_title = f"skinbayes {release}"
html_static_path = ["_static"]
html_favicon = "_static/favicon.svg"
html_context = {"default_mode": "auto"}
html_css_files = ["site.css"]
html_extra_path = ["_root"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True


def write_mathml(translator: Any, node: Any) -> None:
    """Formulas as MathML, which browsers draw and screen readers read without a script."""
    from docutils.nodes import SkipNode
    from latex2mathml.converter import convert
    from sphinx.ext.mathjax import nodes as mathjax_nodes

    block = isinstance(node, mathjax_nodes.math_block)
    formula = convert(node.astext(), display="block" if block else "inline")
    translator.body.append(f'<div class="formula" tabindex="0">{formula}</div>' if block else formula)
    raise SkipNode


def keep_bars(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Bars in docstrings are those of absolute values, not of substitutions."""
    for i, line in enumerate(lines):
        if ">>>" not in line:
            parts = line.split("``")  # every second one is literal
            lines[i] = "``".join(part if n % 2 else part.replace("|", r"\|") for n, part in enumerate(parts))


def name_the_rest(app: Sphinx, page: str, content: list[str]) -> None:
    """Pages that no navigation names come last in that of the background, where ``the-rest`` stands."""
    if "\nthe-rest\n" in content[0]:
        docs = Path(app.srcdir) / "docs"
        named = {line for path in docs.glob("*.md") for line in path.read_text(encoding="utf-8").splitlines()}
        rest = sorted(path.stem for path in docs.glob("*.md") if path.stem not in named | {"index"})
        content[0] = content[0].replace("\nthe-rest\n", "\n" + "".join(f"{one}\n" for one in rest))


def setup(app: Sphinx) -> None:
    """Add the renderer of formulas, and what docstrings and code fences need."""
    from pygments.lexers.special import TextLexer

    app.add_html_math_renderer("mathml", (write_mathml, None), (write_mathml, None))
    app.connect("autodoc-process-docstring", keep_bars, priority=400)
    app.connect("source-read", name_the_rest)
    app.add_lexer("csv", TextLexer)
    app.add_lexer("console", TextLexer)
