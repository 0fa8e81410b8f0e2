"""From the outputs of a part to tables in docs/data. The first line of a table says where it comes from, after a #."""
import csv
import io
import json
import re


def rows_of(text):
    """A table, without what does not belong to it: comments, and the summary that some programs print below."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    width = lines[0].count(",") if lines else 0
    return list(csv.DictReader(line for line in lines if line.count(",") >= max(1, width)))


def read_table(path):
    with open(str(path)) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def text_of(header, rows):
    text = io.StringIO()
    table = csv.DictWriter(text, header, lineterminator="\n", extrasaction="ignore")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()


class Publisher:
    def __init__(self, data, scratch, stamp):
        self.data, self.scratch, self.stamp = data, scratch, stamp

    def write(self, name, header, rows):
        self.data.mkdir(parents=True, exist_ok=True)
        (self.data / name).write_text("# %s\n%s" % (self.stamp, text_of(header, rows)))

    def table(self, name, rows):
        if not rows:
            raise SystemExit("qualify: no rows for %s" % name)
        self.write(name, list(rows[0]), rows)

    def file(self, name):
        """One that the program has written itself."""
        self.table(name, read_table(self.scratch / name))

    def note(self, what, command, result):
        """A row of reliability.csv, in place of the one of an earlier run."""
        path = self.data / "reliability.csv"
        rows = read_table(path) if path.exists() else []
        rows = [row for row in rows if row["what"] != what]
        commit = re.search(r"commit ([^,]*)", self.stamp)[1]
        rows.append({"what": what, "command": "`%s`" % command, "result": result, "commit": commit, "date": self.stamp[-10:]})
        self.write("reliability.csv", list(rows[-1]), sorted(rows, key=lambda row: row["what"]))


def benchmark_rows(text):
    """Of Google Benchmark's JSON: its CSV cannot hold rows with counters of their own."""
    return [{"name": b["name"], "iterations": b["iterations"], "real_time": "%.4f" % b["real_time"], "cpu_time": "%.4f" % b["cpu_time"],
             "time_unit": b["time_unit"], "items_per_second": "%.6g" % b["items_per_second"] if "items_per_second" in b else ""}
            for b in json.loads(text[text.index("{"):])["benchmarks"] if not b.get("error_occurred")]


def best_of(tables):
    """Of several runs of real_time: at each point the fastest, and the least of the slowest tau."""
    merged = [dict(row) for row in tables[0]]
    for table in tables[1:]:
        for best, row in zip(merged, table):
            if float(row["times_real_time"]) > float(best["times_real_time"]):
                best["times_real_time"] = row["times_real_time"]
            if float(row["slowest_tau_us"]) < float(best["slowest_tau_us"]):
                best["slowest_tau_us"] = row["slowest_tau_us"]
    return merged


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else "no output"
