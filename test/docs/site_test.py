#!/usr/bin/python3
"""The site is built without a warning, loads nothing from the network, and has the reference of every public header and
of every name of the Python module. Links: Sphinx warns of those that lead nowhere, and the test links.

usage: site_test.py ROOT DEVEL OUTPUT
"""
import re
import subprocess
import sys
from pathlib import Path

LOADED = re.compile(r'<(?:img|script|iframe)\b[^>]*?\bsrc="([^"]+)"|<link\b[^>]*?\bhref="([^"]+)"')


def check_network(pages):
    for name, text in pages.items():
        for link in (one or other for one, other in LOADED.findall(text)):
            if re.match(r'https?:|//', link):
                yield '%s loads %s' % (name, link)


def check_reference(root, pages):
    text = ''.join(path.read_text() for path in sorted((root / 'docs/api').glob('cpp_*.rst')))
    shown = sorted(re.findall(r'^- (afm/\S+\.h)$', text, re.M))
    there = [str(path.relative_to(root / folder))
             for folder, name in (('include', 'afm'), ('dynamics/include', 'afm/dynamics'))
             for path in sorted((root / folder / name).glob('*.h')) if path.name != 'afm.h']
    if shown != sorted(there):
        yield 'docs/api: not each public header once: %s' % sorted(set(shown) ^ set(there))
    names = re.search(r'__all__ = \[(.*?)\]', (root / 'python/afm/__init__.py').read_text(), re.S)
    site = ''.join(pages.values())
    for name in re.findall(r"'([^_']\w+)'", names[1]):
        if 'id="afm.%s"' % name not in site:
            yield 'no reference of afm.%s' % name


def main(root, devel, output):
    root, site = Path(root).resolve(), Path(output).resolve() / 'html'
    built = subprocess.run([str(root / 'scripts/docs'), '--built', devel, '--output', output],
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    print(built.stdout)
    if built.returncode != 0:
        return 1
    pages = {str(path.relative_to(site)): path.read_text(encoding='utf-8') for path in sorted(site.rglob('*.html'))}
    faults = [*check_network(pages), *check_reference(root, pages)]
    for fault in faults:
        print('FAULT: ' + fault)
    print('%d pages, %d faults' % (len(pages), len(faults)))
    return 1 if faults or len(pages) < 20 else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
