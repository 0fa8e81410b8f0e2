#!/usr/bin/python3
"""Makes one table or picture of the laboratory from the tables that it reads.

Usage: make.py MODE table|picture NAME TABLES DATA OUTPUT
TABLES, DATA: the folders of what was measured and of what is made.
"""
import importlib
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import results  # noqa: E402,F401  (registers its tables)
from measure import commit, stamp  # noqa: E402
from registry import PICTURES, TABLES, Tables, names_read, text_of  # noqa: E402

for module in sorted((Path(__file__).resolve().parent / "plotting").glob("[!_]*.py")):
    importlib.import_module("plotting." + module.stem)


def stamp_of(name, tables, mode):
    """Of a table that is made: the commits, machines and dates of the measurements that it is made from."""
    what = "`snakemake %s`" % name
    read = [re.search(r", (commit .*?, \d{4}-\d\d-\d\d)", tables.stamp(source))
            for source in names_read(TABLES[name], tables.quick)]
    measured = sorted({found.group(1) for found in read if found})
    return "# %s run of %s, %s" % (mode, what, "; ".join(measured)) if measured else stamp(mode, what, commit())


def main():
    mode, kind, name, measured, data, output = sys.argv[1:]
    tables = Tables(measured, data, quick=mode == "quick")
    if kind == "table":
        Path(output).write_text("%s\n%s" % (stamp_of(name, tables, mode), text_of(TABLES[name], tables)))
        return
    PICTURES[name].make(tables).savefig(output)


if __name__ == "__main__":
    main()
