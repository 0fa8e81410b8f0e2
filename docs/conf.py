"""Sphinx builds the site from these pages (scripts/docs). They are plain Markdown, to be read on a code host too."""
import os
import sys
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / 'docs/site'))

project = 'afm_emulator'
version = release = xml.etree.ElementTree.parse(str(ROOT / 'package.xml')).findtext('version')
copyright = 'afm_emulator contributors, BSD-3-Clause'  # noqa: A001  # Sphinx's name

root_doc = 'index'
exclude_patterns = ['data', 'images', 'site']
extensions = ['myst_parser', 'breathe', 'sphinx.ext.autodoc', 'sphinx_copybutton',
              'site_mathematics', 'site_pages', 'site_python']  # in docs/site

myst_enable_extensions = ['dollarmath', 'html_image']
myst_heading_anchors = 4  # of headings up to this level, as a code host makes them
html_math_renderer = 'mathml'  # site_mathematics
highlight_language = 'none'  # formulas are indented blocks

breathe_projects = {'afm': os.environ.get('AFM_DOXYGEN_XML', str(ROOT / 'build/docs/xml'))}  # scripts/docs writes it
breathe_default_project = 'afm'
breathe_show_include = True

autodoc_default_options = {'members': True}
autodoc_member_order = 'bysource'
autoclass_content = 'both'
add_module_names = False

html_theme = 'furo'
html_title = 'afm_emulator %s' % version
html_static_path = ['site/site.css']
html_css_files = ['site.css']
html_copy_source = False
html_theme_options = {'navigation_with_keys': True}
copybutton_exclude = '.linenos, .gp, .go'
