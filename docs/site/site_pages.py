"""What plain Markdown does not say to Sphinx: the sidebar, where links out of the pages lead, and what a header holds.

The lists of links in index.md are the sidebar: each of its headings with such a list is a part.
"""
import re
from pathlib import Path

from docutils import nodes
from sphinx.errors import ExtensionError

OUTSIDE = ('history',)  # pages that are linked, and stand in no part
LINK = re.compile(r'\[([^\]]+)\]\((\.\./[^)#\s]+)\)')
LONG_NAME = re.compile(r'(\b\w{6,})/(?=\w{4})')
FILE_NAME = re.compile(r'\[(\w+)\.md\]\(\1\.md((?:#[\w-]*)?)\)')
HEADER = re.compile(r'^- (afm/\S+\.h)$', re.M)
PAGE = re.compile(r'^- \[([^\]]+)\]\(([\w./-]+)\.(?:md|rst)\)', re.M)


def parts(index):
    """[(heading, [(title, page)])]"""
    sections = re.split(r'^## (.*)\n', index, flags=re.M)[1:]
    found = [(heading, PAGE.findall(text)) for heading, text in zip(sections[::2], sections[1::2])]
    return [(heading, pages) for heading, pages in found if pages]


def sidebar(index):
    lists = []
    for heading, pages in parts(index):
        entries = '\n'.join('%s <%s>' % entry for entry in pages)
        lists.append('```{toctree}\n:hidden:\n:caption: %s\n\n%s\n```\n' % (heading, entries))
    if not lists:
        raise ExtensionError('index.md: no heading has a list of pages')
    return '\n' + '\n'.join(lists)


def by_title(titles):
    """A link that shows a file's name shows the page's name in the sidebar."""
    def rewritten(found):
        return '[%s](%s.md%s)' % (titles.get(found[1], found[1]), found[1], found[2])
    return rewritten


def link_out(folder):
    """A file outside the pages comes with the site; a directory or a document of the tree is named."""
    def rewritten(found):
        target = folder / found[2]
        is_named = target.is_dir() or target.suffix in ('.md', '.rst')
        return '%s (`%s`)' % (found[1], found[2].replace('../', '')) if is_named and '`' not in found[1] else (
            found[1] if is_named else found[0])
    return rewritten


def reference(found):
    """A public header that stands in a list is a section: what Doxygen has read in it."""
    return '%s\n%s\n\n.. doxygenfile:: %s\n' % (found[1], '-' * len(found[1]), found[1])


def prepare(app, page, source):
    text = LINK.sub(link_out(Path(app.env.doc2path(page)).parent), source[0])
    titles = {name: title for _, pages in parts(Path(app.env.doc2path('index')).read_text()) for title, name in pages}
    text = HEADER.sub(reference, FILE_NAME.sub(by_title(titles), text))
    if page == 'index':
        text += sidebar(text)
    if page in OUTSIDE:
        text = '---\norphan: true\n---\n' + text
    source[0] = text


def let_types_break(app, tree, page):
    """In a table diagnostic_msgs/DiagnosticArray and the like may break: they leave the last column no room."""
    for entry in tree.findall(nodes.entry):
        for text in list(entry.findall(nodes.Text)):
            if not isinstance(text.parent, nodes.literal):
                text.parent.replace(text, nodes.Text(LONG_NAME.sub('\\1/\u200b', text)))


def setup(app):
    app.connect('source-read', prepare)
    app.connect('doctree-resolved', let_types_break)
    return {'parallel_read_safe': True}
