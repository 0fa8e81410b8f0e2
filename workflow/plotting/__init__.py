"""The pictures of the documents: a function each, with one look."""
