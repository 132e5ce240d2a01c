"""Files: `read` and `write` pick the format by the suffix; `open` keeps what surrounds the splines.

A format module has ``decode(data, remark)``, which returns the splines in the bytes of a file, and
``encode(splines, accuracy)``, which returns the bytes and the error bound of what they hold. One that writes in place
also has ``opened(data, remark)``, which returns a `Content`.
"""

from knotwork.files.document import Document, open_document
from knotwork.files.formats import ELSEWHERE, FORMATS, SUFFIXES, Format, Written, read, write
from knotwork.files.places import Place

open = open_document

__all__ = ["ELSEWHERE", "FORMATS", "SUFFIXES", "Document", "Format", "Place", "Written", "open", "read", "write"]
