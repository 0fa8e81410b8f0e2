"""What a tool prints: its table, and what it complains of."""
import csv
import os
import subprocess

TIME_LIMIT_S = float(os.environ.get('AFM_TIME_LIMIT', '100'))  # under a sanitizer all takes longer


def run_tool(*command, text=None):
    """The exit code, the rows as dictionaries, and the standard error. text: the standard input."""
    done = subprocess.run(command, input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          timeout=TIME_LIMIT_S)
    lines = done.stdout.splitlines()
    columns = lines[0].split(',') if lines else []
    assert len(columns) == len(set(columns)), columns  # of two with one name a reader sees one
    return done.returncode, list(csv.DictReader(lines)), done.stderr
