# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document jobs: the CAM jobs of a FreeCAD document, read without FreeCAD.

The path of a document enters; name and label of each job leave. A batch asks for them before it starts one FreeCAD for
each document, to see whether two results would have one name.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from xml.etree import ElementTree

_CONTENT = "Document.xml"
_JOB = ("Path.Main.Job", "ObjectJob")
"""Module and class of the proxy of a job, which FreeCAD stores."""


def jobs_in(document: Path) -> list[tuple[str, str]]:
    """Name and label of each CAM job, in the order of the document.

    Args:
        document: path of a FreeCAD document; of one that cannot be read there are none, and FreeCAD tells why.
    """
    try:
        with zipfile.ZipFile(document) as container, container.open(_CONTENT) as content:
            root = ElementTree.parse(content).getroot()
    except (OSError, KeyError, zipfile.BadZipFile, ElementTree.ParseError):
        return []
    objects = root.findall("ObjectData/Object")
    return [(item.get("name", ""), _label(item)) for item in objects if _is_job(item)]


def _is_job(item: ElementTree.Element) -> bool:
    proxies = item.findall("Properties/Property[@name='Proxy']/Python")
    return any((proxy.get("module"), proxy.get("class")) == _JOB for proxy in proxies)


def _label(item: ElementTree.Element) -> str:
    label = item.find("Properties/Property[@name='Label']/String")
    return item.get("name", "") if label is None else label.get("value", "")
