"""Where the data of a fit come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from skinbayes.report import opening

if TYPE_CHECKING:
    from skinbayes.fit import Fit


def data_origin(fit: Fit) -> dict[str, Any]:
    """Where the data come from; what a file without provenance does not say is empty."""
    from skinbayes.files.provenance import TEXTS

    known = fit.provenance["data"]
    origin = known.get("origin", {})
    return {
        "key": opening.data_name(fit),
        "rows": str(known.get("rows", fit.groups["observed_data"].sizes["row"])),
        "sha256": str(known.get("sha256", "")),
        **{name: str(origin.get(name) or "") for name in ("title", *TEXTS)},
        "doi": [str(doi) for doi in origin.get("doi", [])],
        "authors": ", ".join(origin.get("authors", [])),
        "caveats": list(origin.get("caveats", [])),
    }
