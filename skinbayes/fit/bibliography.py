"""Works that a fit may rest on, as text and as BibTeX."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_SPECIAL = str.maketrans(
    {c: f"\\{c}" for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
)  # fmt: skip


@dataclass(frozen=True)
class Reference:
    """One work.

    Attributes
    ----------
    key : of the BibTeX entry
    authors : initials and family name each, or the name of a group
    title : of the work
    use : what it was used for, a few words
    year, journal, volume, pages : where it was printed; empty for data and software
    doi : digital object identifiers, without a resolver address
    version : of software
    """

    key: str
    authors: tuple[str, ...]
    title: str
    use: str
    year: str = ""
    journal: str = ""
    volume: str = ""
    pages: str = ""
    doi: tuple[str, ...] = ()
    version: str = ""

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> Reference:
        """A reference from its fields as they come from a file, where tuples are lists."""
        fields: dict[str, Any] = {}
        for name, value in entry.items():
            fields[name] = tuple(value) if isinstance(value, list) else value
        return cls(**fields)

    def to_dict(self) -> dict[str, Any]:
        """Its fields as a file can hold them, with lists for tuples."""
        return {
            name: list(value) if isinstance(value, tuple) else value for name, value in vars(self).items()
        }

    def text(self) -> str:
        """One line, as in a list of references.

        Examples
        --------
        >>> PERSSON_2001.text().partition(", The Journal")[2]
        ' of Chemical Physics 115 (2001) 3840, doi 10.1063/1.1388626 (area of real contact)'
        """
        printed = f"{self.journal} {self.volume} ({self.year}) {self.pages.partition('-')[0]}"
        parts = [
            ", ".join(self.authors),
            self.title,
            printed if self.journal else self.year,
            f"version {self.version}" if self.version else "",
            f"doi {', '.join(self.doi)}" if self.doi else "",
        ]
        return f"{', '.join(part for part in parts if part)} ({self.use})"

    def bibtex(self) -> str:
        """The BibTeX entry; characters with a meaning in TeX are escaped, letters outside ASCII are left (for biber).

        Examples
        --------
        >>> print(Reference("data", ("A. & B. Lab",), "50 % wet", "data", doi=("10.1234/a_b",)).bibtex())
        @misc{data,
          author = {{A. \\& B. Lab}},
          title = {{50 \\% wet}},
          doi = {10.1234/a_b},
          note = {data},
        }
        """
        authors = [_author(name) for name in self.authors]
        fields = {
            "author": " and ".join(authors),
            "title": f"{{{_escaped(self.title)}}}",
            "journal": _escaped(self.journal),
            "year": _escaped(self.year),
            "volume": _escaped(self.volume),
            "pages": _escaped(self.pages.replace("-", "--")),
            "version": _escaped(self.version),
            "doi": ", ".join(re.sub(r"[{}\\\s]", "", doi) for doi in self.doi),
            "note": _escaped(self.use),
        }
        kind = "article" if self.journal else "software" if self.version else "misc"
        lines = [f"  {name} = {{{value}}}," for name, value in fields.items() if value]
        return "\n".join([f"@{kind}{{{self.key},", *lines, "}"])


def key_of(text: str) -> str:
    """A BibTeX key: letters, digits and hyphens of a text.

    Examples
    --------
    >>> key_of("my déjà data, 2.csv")
    'my-deja-data-2-csv'
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-") or "data"


def _escaped(text: str) -> str:
    return " ".join(text.split()).translate(_SPECIAL)


def _author(name: str) -> str:
    """A person as ``Family, I. N.``; what is not initials and one family name stays as it is, in braces."""
    match = re.fullmatch(r"((?:[^\W\d_]\.[ -]?)+)([^\s&,{}\\]+(?: [^\s&,{}\\]+)?)", name)
    return f"{_escaped(match[2])}, {_escaped(match[1])}" if match else f"{{{_escaped(name)}}}"


PERSSON_2013 = Reference(
    "persson2013skin", ("B. N. J. Persson", "A. Kovalev", "S. N. Gorb"),
    "Contact Mechanics and Friction on Dry and Wet Human Skin", "contact and friction of skin",
    "2013", "Tribology Letters", "50", "17-30", ("10.1007/s11249-012-0053-2",),
)  # fmt: skip
PERSSON_2001 = Reference(
    "persson2001theory", ("B. N. J. Persson",),
    "Theory of rubber friction and contact mechanics", "area of real contact",
    "2001", "The Journal of Chemical Physics", "115", "3840-3861", ("10.1063/1.1388626",),
)  # fmt: skip
YANG_PERSSON = Reference(
    "yang2008contact", ("C. Yang", "B. N. J. Persson"),
    "Contact mechanics: contact area and interfacial separation from small contact to full contact",
    "correction of contact area and separation",
    "2008", "Journal of Physics: Condensed Matter", "20", "215214", ("10.1088/0953-8984/20/21/215214",),
)  # fmt: skip
ELASTOPLASTIC = Reference(
    "persson2001elastoplastic", ("B. N. J. Persson",),
    "Elastoplastic Contact between Randomly Rough Surfaces", "plastic yield of the layer",
    "2001", "Physical Review Letters", "87", "116101", ("10.1103/PhysRevLett.87.116101",),
)  # fmt: skip
SEPARATION = Reference(
    "persson2007relation", ("B. N. J. Persson",),
    "Relation between Interfacial Separation and Load: A General Theory of Contact Mechanics", "mean separation",
    "2007", "Physical Review Letters", "99", "125502", ("10.1103/PhysRevLett.99.125502",),
)  # fmt: skip
GAPS = Reference(
    "almqvist2011interfacial", ("A. Almqvist", "C. Campañá", "N. Prodanov", "B. N. J. Persson"),
    "Interfacial separation between elastic solids with randomly rough surfaces: Comparison between theory and numerical "
    "techniques", "distribution of gaps",
    "2011", "Journal of the Mechanics and Physics of Solids", "59", "2355-2369", ("10.1016/j.jmps.2011.08.004",),
)  # fmt: skip
CAPILLARY = Reference(
    "persson2008capillary", ("B. N. J. Persson",),
    "Capillary adhesion between elastic solids with randomly rough surfaces", "capillary bridges",
    "2008", "Journal of Physics: Condensed Matter", "20", "315007", ("10.1088/0953-8984/20/31/315007",),
)  # fmt: skip
MIXED_LUBRICATION = Reference(
    "persson2009transition", ("B. N. J. Persson", "M. Scaraggi"),
    "On the transition from boundary lubrication to hydrodynamic lubrication in soft contacts", "mixed lubrication",
    "2009", "Journal of Physics: Condensed Matter", "21", "185002", ("10.1088/0953-8984/21/18/185002",),
)  # fmt: skip
FLOW_FACTORS = Reference(
    "persson2011lubricated", ("B. N. J. Persson", "M. Scaraggi"),
    "Lubricated sliding dynamics: Flow factors and Stribeck curve", "flow and shear of the liquid",
    "2011", "The European Physical Journal E", "34", "113", ("10.1140/epje/i2011-11113-9",),
)  # fmt: skip
EMCEE = Reference(
    "foremanmackey2013emcee", ("D. Foreman-Mackey", "D. W. Hogg", "D. Lang", "J. Goodman"),
    "emcee: The MCMC Hammer", "sampler emcee",
    "2013", "Publications of the Astronomical Society of the Pacific", "125", "306-312", ("10.1086/670067",),
)  # fmt: skip
DIFFERENTIAL_EVOLUTION = Reference(
    "terbraak2006markov", ("C. J. F. ter Braak",),
    "A Markov Chain Monte Carlo version of the genetic algorithm Differential Evolution: easy Bayesian computing for real "
    "parameter spaces", "moves of the sampler",
    "2006", "Statistics and Computing", "16", "239-249", ("10.1007/s11222-006-8769-1",),
)  # fmt: skip
DYNESTY = Reference(
    "speagle2020dynesty", ("J. S. Speagle",),
    "dynesty: a dynamic nested sampling package for estimating Bayesian posteriors and evidences", "sampler dynesty",
    "2020", "Monthly Notices of the Royal Astronomical Society", "493", "3132-3158", ("10.1093/mnras/staa278",),
)  # fmt: skip
NESTED_SAMPLING = Reference(
    "skilling2006nested", ("J. Skilling",), "Nested sampling for general Bayesian computation", "method of the sampler",
    "2006", "Bayesian Analysis", "1", "833-859", ("10.1214/06-BA127",),
)  # fmt: skip
R_HAT = Reference(
    "vehtari2021rank", ("A. Vehtari", "A. Gelman", "D. Simpson", "B. Carpenter", "P.-C. Bürkner"),
    "Rank-Normalization, Folding, and Localization: An Improved R-hat for Assessing Convergence of MCMC", "convergence",
    "2021", "Bayesian Analysis", "16", "667-718", ("10.1214/20-BA1221",),
)  # fmt: skip
ARVIZ = Reference(
    "kumar2019arviz", ("R. Kumar", "C. Carroll", "A. Hartikainen", "O. Martin"),
    "ArviZ a unified library for exploratory analysis of Bayesian models in Python", "ArviZ, schema of the result",
    "2019", "Journal of Open Source Software", "4", "1143", ("10.21105/joss.01143",),
)  # fmt: skip
