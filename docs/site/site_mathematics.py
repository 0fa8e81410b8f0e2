"""Mathematics as MathML, which browsers typeset by themselves: it needs neither the network nor a script."""
from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml


def visit_inline(translator, node):
    translator.body.append(tex2mathml(node.astext(), inline=True))
    raise nodes.SkipNode


def visit_block(translator, node):
    translator.body.append('<div class="math">%s</div>' % tex2mathml(node.astext(), inline=False))
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer('mathml', (visit_inline, None), (visit_block, None))
    return {'parallel_read_safe': True}
