"""The tables and pictures made from what was measured: each a function, with the names of the tables that it reads."""
import csv
import io
from collections import OrderedDict, namedtuple
from pathlib import Path

Product = namedtuple("Product", "make reads full_only")

TABLES, PICTURES, SHORT_TABLES = OrderedDict(), OrderedDict(), OrderedDict()


def _register(products, reads, full_only=False, name=None):
    def decorate(function):
        products[name or function.__name__] = Product(function, reads, full_only)
        return function
    return decorate


# `reads`: names, or a function of `quick` that gives them
def table(*reads, full_only=False):
    """Of a function that gives (columns, rows), or rows that are dictionaries."""
    return _register(TABLES, reads, full_only)


def short_table(*reads):
    """The same, rendered from tables in docs/data for a document."""
    return _register(SHORT_TABLES, reads)


def picture(*reads, name=None):
    """Of a function that gives a figure. `name`: where a table has the name of the picture."""
    return _register(PICTURES, reads, name=name)


def names_read(product, quick):
    names = [read(quick) if callable(read) else [read] for read in product.reads]
    return [name for several in names for name in several]


def numbers(row):
    """The fields of a row as numbers where they are numbers."""
    result = {}
    for key, text in row.items():
        try:
            result[key] = float(text)
        except ValueError:
            result[key] = text
    return result


class Tables:
    """The tables of one run, in a folder; `other`: a second folder in which they may be."""

    def __init__(self, *folders, quick=False):
        self.folders, self.quick = [Path(folder) for folder in folders], quick

    def path(self, name):
        paths = [folder / (name + ".csv") for folder in self.folders]
        return next((path for path in paths if path.exists()), paths[0])

    def text(self, name):
        """Without the line that says where it comes from."""
        return "".join(line for line in self.path(name).open() if not line.startswith("#"))

    def stamp(self, name):
        return self.path(name).open().readline()

    def strings(self, name):
        """The rows of a table, without the summary that some programs print below."""
        lines = [line for line in self.text(name).splitlines() if line]
        width = len(next(csv.reader(lines[:1]))) - 1 if lines else 0
        return list(csv.DictReader(line for line in lines if line.count(",") >= max(1, width)))

    def rows(self, name):
        return [numbers(row) for row in self.strings(name)]

    def seconds(self, name):
        """How long the command of this table ran."""
        return float(self.stamp(name).rsplit(",", 1)[1].split()[0])


def text_of(product, tables):
    """The table as text."""
    made = product.make(tables)
    columns, rows = made if isinstance(made, tuple) else (list(made[0]), [list(row.values()) for row in made])
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(["%.6g" % field if isinstance(field, float) else field for field in row] for row in rows)
    return text.getvalue()
