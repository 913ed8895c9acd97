"""Runs many sequences with Snakemake, on one machine or on a cluster, and summarises them: ``quadedge batch``."""

import importlib.metadata

NEEDED = 9  # before, --executor was missing

try:
    _found = importlib.metadata.version("snakemake")
except importlib.metadata.PackageNotFoundError:
    raise ModuleNotFoundError("No module named 'snakemake'", name="snakemake") from None
if int(_found.split(".")[0]) < NEEDED:
    raise ImportError(f"Snakemake {_found}; expected {NEEDED} or later", name="snakemake")
