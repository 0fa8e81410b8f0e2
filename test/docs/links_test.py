#!/usr/bin/python3
"""Every link and picture of the documents leads to a file, every heading that is linked exists, every picture has a
text, and every document and picture is reached from somewhere, every page of the site from the lists of docs/index.md.
usage: links_test.py ROOT"""
import re
import sys
from pathlib import Path

LINK = re.compile(r'(!?)\[([^\]]*)\]\(([^)\s]+)\)')
IMAGE = re.compile(r'<img\s[^>]*>', re.S)
NAMED = re.compile(r'`((?:docs|config|scripts|include|src|test|examples|benchmark|launch|msg|srv)/[\w./-]+)`')
FENCED = re.compile(r'^```.*?^```', re.S | re.M)


def without_code(text):
    return FENCED.sub('', text)


def anchors(path):
    """As GitHub makes them of headings."""
    return {re.sub(r'[^\w\- ]', '', heading.lower()).strip().replace(' ', '-')
            for heading in re.findall(r'^#+ (.*)', without_code(path.read_text()), re.M)}


def check_link(document, target):
    name, _, anchor = target.partition('#')
    path = (document.parent / name).resolve() if name else document
    if not path.exists():
        return 'no %s' % target
    if anchor and anchor not in anchors(path):
        return 'no heading %s' % target
    return None


def faults_of(document, root, reached):
    text = without_code(document.read_text())
    links = [(is_picture, said, target) for is_picture, said, target in LINK.findall(text)]
    for tag in IMAGE.findall(text):
        fields = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        links.append(('!', fields.get('alt', ''), fields['src']))
    for is_picture, said, target in links:
        if re.match(r'https?:', target):
            continue
        fault = check_link(document, target)
        if fault:
            yield fault
        if is_picture and not said:
            yield 'a picture without a text: %s' % target
        reached.add((document.parent / target.partition('#')[0]).resolve())
    for name in NAMED.findall(text):
        if not (root / name).exists() and not re.search(r'/[A-Z]+(\.|$)', name):  # TARGET.cpp stands for any
            yield 'no %s' % name


def main(root):
    root, reached, faults = Path(root).resolve(), set(), []
    documents = sorted(root.glob('*.md')) + sorted((root / 'docs').glob('*.md'))
    for document in documents + sorted(root.glob('examples/**/*.md')):
        faults += ['%s: %s' % (document.name, fault) for fault in faults_of(document, root, reached)]
    for path in documents + sorted((root / 'docs/images').glob('*.png')):
        if path not in reached and path != root / 'README.md':
            faults.append('no document leads to %s' % path.relative_to(root))
    sidebar = set(re.findall(r'^- \[[^\]]+\]\(([\w/]+\.\w+)\)', (root / 'docs/index.md').read_text(), re.M))
    for path in sorted((root / 'docs').glob('*.md')) + sorted((root / 'docs/api').glob('*.rst')):
        if str(path.relative_to(root / 'docs')) not in sidebar | {'index.md', 'history.md'}:
            faults.append('docs/index.md: no line of its lists leads to %s' % path.relative_to(root))
    version = re.search(r'<version>(.*)</version>', (root / 'package.xml').read_text()).group(1)
    if 'version: %s\n' % version not in (root / 'CITATION.cff').read_text():
        faults.append('CITATION.cff: not version %s' % version)
    assert len(documents) > 10 and len(reached) > 40, 'hardly any link was found in %s' % root
    for fault in faults:
        print('FAULT: ' + fault)
    print('%d documents, %d targets, %d faults' % (len(documents), len(reached), len(faults)))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1]))
