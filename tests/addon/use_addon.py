# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post with an add-on that the Addon Manager has installed; `make addon` runs it inside FreeCAD without another one."""

import sys
from pathlib import Path

import FreeCAD as App

sys.path.insert(0, str(Path(__file__).parents[1] / "freecad_app"))

from cam_jobs import add_operation, new_job
from Path.Post.Processor import PostProcessorFactory

import pkm_post
from pkm_post.system import packages

folder = Path(App.getUserAppDataDir(), "Mod", "pkm-post")

assert Path(pkm_post.__file__).is_relative_to(folder), pkm_post.__file__
document = App.newDocument("installed")
job = new_job(document)
add_operation(job)
document.recompute()
document.saveAs(sys.argv[1] + "/installed.FCStd")

post = PostProcessorFactory.get_post_processor(job, "hexapod_pmac")
assert type(post).__name__ == "HexapodPmac", type(post)

(posted,) = pkm_post.post(job, out=sys.argv[1], arguments="--work-offset=0,0,250")
assert posted.report["certificate"]["holds"]
assert Path(posted.program).stat().st_size > 0
(from_file,) = pkm_post.post(
    sys.argv[1] + "/installed.FCStd", out=sys.argv[1] + "/again", arguments="--work-offset=0,0,250"
)
assert Path(from_file.program).read_bytes() == Path(posted.program).read_bytes()
packages.OPTIONAL["no_such_module"] = "no-such-package"
assert packages.missing()[-1] == "no_such_module"
assert packages.cure("no_such_module").startswith("choose Install packages in the workbench PKM Post, or type: ")
print(f"posted {posted.program} and {from_file.program}")
