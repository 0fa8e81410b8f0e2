"""Signatures of compiled classes: types from the stub python/afm/_afm.pyi, defaults from the docstrings of pybind11.

Docstrings explain an argument in a line that begins with its name. Such lines become the list of parameters.
"""
import ast
import re
from pathlib import Path

STUB = Path(__file__).resolve().parents[2] / 'python/afm/_afm.pyi'
ARGUMENT = re.compile(r'(\w+(?:, \w+)*): (?=\S)')


def stub_functions():
    """{'Tip.advance': the node of its definition}"""
    found = {}
    for class_ in ast.parse(STUB.read_text()).body:
        if isinstance(class_, ast.ClassDef):
            found.update({'%s.%s' % (class_.name, f.name): f for f in class_.body if isinstance(f, ast.FunctionDef)})
    return found


FUNCTIONS = stub_functions()


def defaults_in(docstring):
    """{argument: default}, as pybind11 wrote them in the first line."""
    line = (docstring or '').split('\n')[0]
    line = re.sub(r'(Model|Bath)\([^()]*\)', r'\1()', line)  # the defaults of the class itself
    return dict(re.findall(r'(\w+): [\w.]+ = ([^,()]*(?:\(\))?)', line))


def signature(name, docstring):
    """(arguments, what is returned) of a function of the stub."""
    function, defaults = FUNCTIONS[name], defaults_in(docstring)
    arguments = function.args
    plain = [a for a in arguments.args if a.arg not in ('self', 'cls')]
    optional = {a.arg for a in plain[len(plain) - len(arguments.defaults):]} if arguments.defaults else set()
    optional |= {a.arg for a, default in zip(arguments.kwonlyargs, arguments.kw_defaults) if default is not None}
    words = []
    for a in plain + ['*'] * bool(arguments.kwonlyargs) + arguments.kwonlyargs:
        if a == '*':
            words.append(a)
            continue
        word = a.arg + (': ' + ast.unparse(a.annotation) if a.annotation else '')
        words.append(word + (' = ' + defaults.get(a.arg, '...') if a.arg in optional else ''))
    returned = ast.unparse(function.returns).strip("'") if function.returns else None
    return '(%s)' % ', '.join(words), returned


def process_signature(app, what, name, obj, options, arguments, returned):
    key = name.replace('afm.', '', 1)
    if what == 'class' and key + '.__init__' in FUNCTIONS:
        return signature(key + '.__init__', obj.__init__.__doc__)[0], None
    if what == 'method' and key in FUNCTIONS:
        return signature(key, obj.__doc__)
    return None


def process_docstring(app, what, name, obj, options, lines):
    """A line `eta, gamma: ...` is the begin of a parameter; lines up to the next one or an empty line go on with it."""
    if what not in ('class', 'method', 'function') or not name.startswith(('afm.', 'afm_emulator.')):
        return
    new, inside = [], False
    for line in lines:
        found = ARGUMENT.match(line)
        if found and not line.startswith(('Returns', 'Throws', 'Here')):
            if not inside:
                new.append('')
            new.append(':param %s: %s' % (found[1].replace(' ', ''), line[found.end():]))
            inside = True
        elif inside and line.strip() and not line.startswith((' ', 'Returns', 'Throws', 'An object')):
            new.append('    ' + line)
        else:
            if inside and line.strip():
                new.append('')
            inside = False
            new.append(line)
    lines[:] = new


def setup(app):
    app.connect('autodoc-process-signature', process_signature)
    app.connect('autodoc-process-docstring', process_docstring)
    return {'parallel_read_safe': True}
