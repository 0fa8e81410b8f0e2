#!/usr/bin/python3
"""Which way the arrows point: reads every include and fails on one that the plan of the tree forbids. The core and its
tests include nothing of ROS; the compiler would not notice, as some systems keep ROS headers where it always looks. Nor
does the core call a function of the math library that another version of it rounds otherwise: bits would depend on the
system.

Usage: arrows_test.py ROOT [--list]     --list prints all arrows between rooms, with how many includes each stands for
"""
import re
import sys
from collections import Counter
from pathlib import Path

# the longest beginning of a path names its room
ROOMS = {'include/afm': 'core', 'include/afm/detail': 'core', 'dynamics/include/afm': 'dynamics',
         'dynamics/src': 'dynamics', 'dynamics/tools': 'studies', 'dynamics/test': 'test',
         'src/core': 'core',
         'src/common': 'common', 'src/sweep': 'sweep', 'src/tools': 'tools', 'src/node': 'node', 'src/view': 'view',
         'src/node/params': 'params', 'src/node/runner': 'runner', 'src/node/publisher': 'publisher',
         'src/node/recorder': 'recorder', 'python': 'python', 'benchmark': 'benchmark', 'benchmark/trials': 'trials',
         'test': 'test'}
ALLOWED = {'core': set(), 'dynamics': {'core'}, 'common': {'core'},
           'studies': {'common', 'core', 'dynamics'}, 'sweep': {'common', 'core'}, 'params': {'core', 'common'},
           'runner': {'core', 'params'}, 'recorder': set(), 'publisher': {'core', 'params', 'runner', 'recorder'},
           'node': {'core', 'params', 'runner', 'publisher', 'recorder'}, 'view': {'core', 'publisher'},
           'tools': {'common', 'core', 'dynamics', 'sweep', 'params', 'publisher', 'recorder'},
           'python': {'core', 'common', 'dynamics', 'studies', 'sweep'}, 'trials': {'core'},
           'benchmark': {'common', 'core', 'trials'},
           'test': {'common', 'core', 'dynamics', 'sweep', 'tools', 'node', 'params', 'runner', 'publisher',
                    'recorder', 'view', 'trials'}}
# after the folder of the file itself
SEARCHED = ('include', 'dynamics/include', 'src', 'dynamics/src', 'dynamics/tools', 'test', 'benchmark')
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
OF_ROS = re.compile(r'^\s*#\s*include\s*[<"]((?:ros|rosbag|std_msgs|std_srvs|diagnostic_\w+|dynamic_reconfigure)/|'
                    r'afm_emulator/[A-Z])', re.M)
WITHOUT_ROS = ('include/afm/', 'src/core/', 'dynamics/', 'test/core/', 'test/support/')
OF_CORE = ('include/afm/', 'src/core/')
INEXACT = re.compile(r'\bstd::(hypot|cbrt|pow|exp\w*|log\w*|a?(?:sin|cos|tan)h?|atan2|erfc?|[tl]gamma)\(')
INSTALLED = ('include/afm/', 'dynamics/include/afm/')


def room(path):
    text = path.as_posix()
    return ROOMS[max((beginning for beginning in ROOMS if text.startswith(beginning + '/')), key=len)]


def target(root, path, name):
    for folder in [path.parent] + [Path(s) for s in SEARCHED]:
        if (root / folder / name).is_file():
            return Path(*(folder / name).parts)
    return None


def sources(root):
    """Every file of C++, and its text."""
    for folder in ('include', 'src', 'dynamics', 'python', 'benchmark', 'test'):
        for path in sorted((root / folder).rglob('*')):
            if path.suffix not in ('.h', '.cpp'):
                continue
            yield path.relative_to(root), path.read_text()


def arrows(root):
    """Of every include: the file, what it includes, and the rooms of both."""
    for path, text in sources(root):
        for name in INCLUDE.findall(text):
            to = target(root, path, name)
            yield path, to or Path(name), room(path), room(to) if to else None


def faults_of_installed(root):
    """Headers that are installed include nothing that is not, and detail/ is the namespace detail, and it alone."""
    for path, to, a, _ in arrows(root):
        if path.as_posix().startswith(INSTALLED) and not to.as_posix().startswith(INSTALLED):
            yield '%s includes %s, which is not installed' % (path, to)
    for path, text in sources(root):
        if path.as_posix().startswith(INSTALLED):
            inside = re.search(r'^namespace (afm::)?detail \{', text, re.M) is not None
            if inside != ('detail' in path.parts):
                yield '%s: afm::detail is for detail/, and detail/ for it' % path


def uses_of_ros(root):
    return [path.as_posix() for path, text in sources(root) if OF_ROS.search(text)]


def inexact_functions(root):
    for path, text in sources(root):
        if path.as_posix().startswith(OF_CORE):
            for name in INEXACT.findall(text):
                yield '%s calls std::%s, of which other systems have other bits' % (path, name)


def main(root, listing=False):
    root, faults, seen = Path(root), [], Counter()
    for path, to, a, b in arrows(root):
        seen[a, b] += 1
        if b is None:
            faults.append('%s includes "%s", which is nowhere' % (path, to))
        elif a != b and b not in ALLOWED[a]:
            faults.append('%s includes %s: %s may not know %s' % (path, to, a, b))
    if listing:
        for (a, b), n in sorted(seen.items(), key=str):
            print('%-10s -> %-10s %4d' % (a, b, n))
    faults += faults_of_installed(root)
    faults += inexact_functions(root)
    of_ros = uses_of_ros(root)
    faults += ['%s includes ROS' % path for path in of_ros if path.startswith(WITHOUT_ROS)]
    assert len(seen) > 10 and len(of_ros) > 10, 'hardly any include was found in %s' % root
    for fault in faults:
        print('FAULT: ' + fault)
    print('%d includes, %d faults' % (sum(seen.values()), len(faults)))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1], '--list' in sys.argv))
