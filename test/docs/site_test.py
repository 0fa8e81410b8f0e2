#!/usr/bin/python3
"""The site is built without a warning, and a reader finds everything in it.

Every link and anchor leads somewhere, every page stands in the sidebar, every public header and every name of the
Python module has its reference, and nothing is loaded from the network.

usage: site_test.py ROOT DEVEL OUTPUT
"""
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse


class Page(HTMLParser):
    """Links, what can be linked to, and what is loaded."""

    def __init__(self, path):
        super().__init__()
        self.path, self.ids, self.links, self.loaded = path, set(), [], []
        self.feed(path.read_text(encoding='utf-8'))

    def handle_starttag(self, tag, attributes):
        fields = dict(attributes)
        self.ids.update(fields[name] for name in ('id', 'name') if fields.get(name))
        if tag == 'a' and fields.get('href'):
            self.links.append(fields['href'])
        for name in ('src', 'href'):
            if tag in ('img', 'script', 'link', 'iframe') and fields.get(name):
                self.loaded.append(fields[name])

    def target(self, link):
        return (self.path.parent / unquote(urlparse(link).path)).resolve() if urlparse(link).path else self.path


def is_remote(link):
    return urlparse(link).scheme in ('http', 'https', 'mailto') or link.startswith('//')


def faults_of(page, pages):
    for link in page.loaded:
        if is_remote(link):
            yield 'loads %s' % link
        elif not link.startswith('data:') and not page.target(link).exists():
            yield 'there is no %s, which it loads' % link
    for link in page.links:
        if is_remote(link):
            continue
        target = page.target(link)
        anchor = unquote(urlparse(link).fragment)
        if not target.exists():
            yield 'no %s' % link
        elif anchor and target in pages and anchor not in pages[target].ids:
            yield 'no anchor %s' % link


def check_reference(root, pages):
    text = ''.join(path.read_text() for path in sorted((root / 'docs/api').glob('cpp_*.rst')))
    shown = sorted(re.findall(r'^\.\. doxygenfile:: (\S+)', text, re.M))
    there = [str(path.relative_to(root / folder))
             for folder, name in (('include', 'afm'), ('dynamics/include', 'afm/dynamics'))
             for path in sorted((root / folder / name).glob('*.h')) if path.name != 'afm.h']
    if shown != sorted(there):
        yield 'docs/api: not each public header once: %s' % sorted(set(shown) ^ set(there))
    names = re.search(r'__all__ = \[(.*?)\]', (root / 'python/afm/__init__.py').read_text(), re.S)
    ids = {name for page in pages.values() for name in page.ids}
    for name in re.findall(r"'([^_']\w+)'", names[1]):
        if 'afm.' + name not in ids:
            yield 'no reference of afm.%s' % name


def main(root, devel, output):
    root, site = Path(root).resolve(), Path(output).resolve() / 'html'
    built = subprocess.run([str(root / 'scripts/docs'), '--built', devel, '--output', output],
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    print(built.stdout)
    if built.returncode != 0:
        return 1
    pages = {path: Page(path) for path in sorted(site.rglob('*.html'))}
    faults = ['%s: %s' % (path.relative_to(site), fault)
              for path, page in pages.items() for fault in faults_of(page, pages)]
    faults += list(check_reference(root, pages))
    for fault in faults:
        print('FAULT: ' + fault)
    print('%d pages, %d links, %d faults' % (len(pages), sum(len(page.links) for page in pages.values()), len(faults)))
    return 1 if faults or len(pages) < 20 else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
