"""The local app: an input in an editor, solved at every change, with its viewer and figures beside it.

A small web server for one user on one machine.  It needs the packages of the extra ``app``.
"""

from crumple.app.access import Access
from crumple.app.folder import Folder
from crumple.app.server import application, serve

__all__ = ["Access", "Folder", "application", "serve"]
