#!/usr/bin/python3
"""Renders what documents show of files: short tables from the long ones in docs/data, tables in documents, code, and
the interface. A document names it in a line of its own,

    <!-- table: data/thermal_peaks.csv -->    <!-- code: ../examples/cpp/one_tip.cpp -->    or
    <!-- interface: message Friction -->      (also: parameters; service NAME; launch NAME)

and what follows, up to the line <!-- end of table --> and so on, is written anew. With --check nothing is written, and
the exit code is 1 where something differs from its files. With --publish it first copies the tables and pictures of a
full run that docs/ has too.
"""
import argparse
import csv
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "workflow"))
import summaries  # noqa: E402,F401  (registers the short tables)
from interface import interface, markdown  # noqa: E402
from registry import SHORT_TABLES, Tables, names_read, text_of  # noqa: E402

DATA = ROOT / "docs/data"
INCLUSION = re.compile(r"(<!-- (table|code|interface): (.+?) -->\n).*?(<!-- end of \2 -->)", re.DOTALL)
LANGUAGES = {".cpp": "cpp", ".py": "python", ".txt": "cmake"}  # of CMakeLists.txt


def publish(run):
    documents = "".join(path.read_text() for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
    for folder, kinds in (("tables", "*.csv"), ("data", "*.csv"), ("images", "*.*")):
        for path in sorted((run / folder).glob(kinds)):
            target = ROOT / "docs" / ("images" if folder == "images" else "data") / path.name
            if target.exists() or "data/%s -->" % path.name in documents:
                shutil.copy(str(path), str(target))
                print("copied", path.name)


def short_tables():
    """(path, text) of those whose data are there."""
    tables = Tables(DATA)
    for name, product in SHORT_TABLES.items():
        if all(tables.path(read).exists() for read in names_read(product, False)):
            yield DATA / (name + ".csv"), text_of(product, tables)


def table(document, name):
    path = document.parent / name
    if not path.exists():
        return "*Not measured on this version: `snakemake %s` measures it.*\n" % path.stem
    with open(str(path)) as file:  # a first line after a # says where a table comes from
        return markdown(*csv.reader(row for row in file if not row.startswith("#")))


def code(document, name):
    path = document.parent / name
    return "```%s\n%s```\n" % (LANGUAGES[path.suffix], path.read_text())


def rendered(document):
    text = document.read_text()
    if len(INCLUSION.findall(text)) != len(re.findall(r"^<!-- (?:table|code|interface): ", text, re.M)):
        sys.exit("%s: something without its end" % document)
    show = {"table": table, "code": code, "interface": interface}
    return INCLUSION.sub(lambda found: "%s\n%s\n%s" % (found[1], show[found[2]](document, found[3]), found[4]), text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing")
    parser.add_argument("--publish", type=Path, metavar="RUN", help="build/laboratory/full")
    arguments = parser.parse_args()
    if arguments.publish:
        publish(arguments.publish)
    stale = []

    def update(path, text):
        if path.exists() and path.read_text() == text:
            return
        stale.append(path.name)
        if not arguments.check:
            path.write_text(text)

    for path, text in short_tables():
        update(path, text)
    for document in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
        update(document, rendered(document))
    if stale:
        print("%s: %s" % ("differ from their files" if arguments.check else "written", ", ".join(stale)))
    sys.exit(1 if arguments.check and stale else 0)


if __name__ == "__main__":
    main()
