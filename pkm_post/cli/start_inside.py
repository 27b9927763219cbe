# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start inside: run the command line of this package in FreeCAD's Python.

``run_script.py`` runs this file. FreeCAD has already imported the package of an add-on. A wheel is installed among
packages for another Python, so only the package itself is imported from there.
"""

import importlib.util
import sys
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]


def _import_package() -> None:
    """Import the package from its folder, and do the part of the add-on's ``Init.py`` that the command line needs."""
    spec = importlib.util.spec_from_file_location(
        "pkm_post", _PACKAGE / "__init__.py", submodule_search_locations=[str(_PACKAGE)]
    )
    if spec is None or spec.loader is None:
        raise ImportError(f"there is no package in {_PACKAGE}")
    package = importlib.util.module_from_spec(spec)
    sys.modules["pkm_post"] = package
    spec.loader.exec_module(package)
    from pkm_post.freecad_app import startup

    startup.install_step_reader()
    startup.install_package_folder()


if __name__ == "__main__":
    if "pkm_post" not in sys.modules:
        _import_package()
    from pkm_post.cli import main
    from pkm_post.cli.processes import inner_exit_code

    sys.exit(inner_exit_code(main(sys.argv[1:])))
