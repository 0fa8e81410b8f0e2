#!/usr/bin/python3
"""What a long recording costs: 1 MHz of samples and all impacts in batches at 1 kHz. Starts a master and an emulator of
its own, prints the share of a core of each thread and the memory in use, then stops and checks the recording.

usage: record_throughput.py DIRECTORY [SECONDS]     (0.02 GB a second go into DIRECTORY, and are left there)"""
import glob
import os
import subprocess
import sys
import time

from emulator import STDERR, emulator, own_master

PARAMETERS = {'record': True, 'sample_rate_hz': 1e6, 'batch_rate_hz': 1000.0}


def threads(pid):
    """Seconds of CPU of each thread, by name."""
    times = {}
    for task in glob.glob('/proc/%d/task/*' % pid):
        try:
            name = open(task + '/comm').read().strip()
            fields = open(task + '/stat').read().rsplit(')', 1)[1].split()
        except OSError:
            continue
        times[name] = times.get(name, 0.0) + (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')
    return times


def resident_mb(pid):
    with open('/proc/%d/statm' % pid) as statm:
        return int(statm.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') / 1e6


def watch(pid, seconds):
    """Says every ten seconds what it costs. Returns seconds, MB, and the per cent of a core of each thread, by name."""
    begin, before = time.monotonic(), threads(pid)
    while time.monotonic() < begin + seconds:
        time.sleep(min(10.0, seconds))
        elapsed, memory, now = time.monotonic() - begin, resident_mb(pid), threads(pid)
        shares = {name: '%.1f' % (100 * (cpu - before.get(name, 0.0)) / elapsed)
                  for name, cpu in sorted(now.items()) if name.startswith('afm_')}
        print('%4.0f s, %4.0f MB resident, per cent of a core: %s'
              % (elapsed, memory, ', '.join('%s %s' % item for item in shares.items())), file=sys.stderr)
    return elapsed, memory, shares


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith('-'):
        sys.exit(__doc__)
    directory, seconds = os.path.abspath(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 600.0
    others = set(glob.glob(directory + '/*.bag'))
    with own_master() as server, emulator(server, dict(PARAMETERS, bag_directory=directory)) as node:
        time.sleep(2.0)
        elapsed, memory, shares = watch(node.pid, seconds)
    bags = sorted(set(glob.glob(directory + '/*.bag')) - others)
    row = {'seconds': '%.0f' % elapsed, 'memory / MB': '%.0f' % memory,
           'recorded / GB': '%.2f' % (sum(os.path.getsize(bag) for bag in bags) / 1e9), **shares}
    print('%s\n%s' % (','.join(row), ','.join(row.values())), flush=True)
    checked = subprocess.call(['rosrun', 'afm_emulator', 'bag_check'] + bags, stdout=STDERR)
    sys.exit(node.returncode or checked)


if __name__ == '__main__':
    main()
