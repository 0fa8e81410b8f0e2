"""The tables of docs/interface.md, of the files that define the interface: parameters; message NAME; service NAME;
launch NAME. A document names one in a line of its own (documents.py).
"""
import re
import textwrap
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FIELD = re.compile(r"(?P<type>[\w/]+(?:\[\])?) +(?P<name>\w+)(?P<constant>=\S+)? *(?:# ?(?P<comment>.*))?$")
PARAMETER = re.compile(r"(?P<name>\w+): +(?P<value>(?:\"[^\"]*\"|[^#\s])+) *(?:# ?(?P<comment>.*))?$")
LEAST_KNOWN = 4  # parameters in a message from which they are listed in a line of their own
UNIT = re.compile(r"\[([^\]]*)\]")


def markdown(header, *rows):
    header, *rows = ("| %s |\n" % " | ".join(cell.replace("|", "\\|") for cell in row) for row in (header, *rows))
    return header + "|" + "---|" * (header.count("|") - 1) + "\n" + "".join(rows)


def split_unit(comment):
    """The unit in brackets, and what is said besides."""
    found = UNIT.search(comment)
    if not found:
        return "", comment
    before, after = comment[:found.start()].rstrip(), comment[found.end():]
    return found.group(1), before + after if before else after.lstrip(" ,;:")


def parameters():
    """Of config/emulator.yaml: (name, default, unit, meaning)."""
    rows = []
    for line in (ROOT / "config/emulator.yaml").read_text().splitlines():
        found = PARAMETER.match(line)
        if found:
            rows.append([found["name"], found["value"], found["comment"] or ""])
        elif rows and re.match(r"\s+# ", line):  # a comment goes on
            rows[-1][2] += " " + line.strip()[2:]
    return [(name, value) + split_unit(comment) for name, value, comment in rows]


def render_parameters(_):
    return markdown(["parameter", "default", "unit", "meaning"],
                    *(["`%s`" % name, "`%s`" % value, unit, meaning] for name, value, unit, meaning in parameters()))


def fields(text):
    rows, head = [], []
    for line in text.splitlines():
        found = FIELD.match(line)
        if found and not line.startswith("#"):
            unit, meaning = split_unit(found["comment"] or "")
            rows.append(["`%s`" % (found["name"] + (found["constant"] or "")), found["type"], unit, meaning])
        elif line.startswith("# ") and not rows:
            head.append(line[2:])
    return head, rows


def wrapped(text):
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def render_fields(text, left_out=()):
    head, rows = fields(text)
    said = wrapped(" ".join(head)) + "\n\n" if head else ""
    return said + markdown(["field", "type", "unit", "meaning"],
                           *(row for row in rows if row[0].strip("`") not in left_out))


def render_message(name):
    """A field that is named like a parameter has its meaning and unit: it is listed, and not explained again."""
    text = (ROOT / "msg" / (name + ".msg")).read_text()
    known = [row[0] for row in fields(text)[1] if row[0].strip("`") in {name for name, *_ in parameters()}]
    if len(known) < LEAST_KNOWN:
        return render_fields(text, ("header", "epoch"))
    return "%s\n%s\n" % (render_fields(text, ["header", "epoch"] + [field.strip("`") for field in known]),
                         wrapped("Parameters: %s." % ", ".join(known)))


def render_service(name):
    asked, answered = (ROOT / "srv" / (name + ".srv")).read_text().split("---\n")
    return "%s\nAnswer:\n\n%s" % (render_fields(asked), render_fields(answered))


def render_launch(name):
    root = xml.etree.ElementTree.parse(str(ROOT / "launch" / (name + ".launch"))).getroot()
    rows = []
    for argument in root.findall("arg"):
        if "value" not in argument.attrib:
            default = argument.get("default", "(required)")
            rows.append(["`%s`" % argument.get("name"),
                         "" if not default else "depends on `scene`" if "$(" in default else
                         "`%s`" % default, " ".join(argument.get("doc", "").split())])
    return markdown(["argument", "default", "meaning"], *rows)


RENDER = {"parameters": render_parameters, "message": render_message, "service": render_service,
          "launch": render_launch}


def interface(_, subject):
    kind, _, name = subject.partition(" ")
    return RENDER[kind](name)
