# SPDX-License-Identifier: LGPL-2.1-or-later
"""PKM Post: from CAM jobs to certified motion programs of 6-TPS parallel kinematic machine tools."""

__version__ = "0.1.0"


def post_job(job, machine=None, out=".", **choices):  # type: ignore[no-untyped-def]
    """Post a CAM job from a macro; same as ``pkm_post.freecad_app.post_job.post_job``.

    Args:
        job: the CAM job, a document object.
        machine: name of a machine that comes with PKM Post, or path of a machine file; None for that of the job.
        out: folder for the results.
        choices: arguments, options, tool_lengths, log and progress of that function.

    Raises:
        pkm_post.model.Refused: as that function, and F130 if memory runs out.
    """
    from pkm_post.freecad_app.post_job import post_job as post
    from pkm_post.system import memory_guard

    with memory_guard(job.Label):
        return post(job, machine, out, **choices)


def post(source, machine=None, out=".", **choices):  # type: ignore[no-untyped-def]
    """Post any supported source: a CAM job, a FreeCAD document, G-code or CL data.

    A job is posted with its stored arguments. Arguments given here override them, which J125 reports.

    Args:
        source: a CAM job, a document object, or the path of a file. A FreeCAD document (``.FCStd``) needs FreeCAD;
            G-code and CL data do not, and are distinguished by the suffix.
        machine: name of a machine that comes with PKM Post, or path of a machine file; None for that of the job, or for
            the example machine.
        out: folder for the results.
        choices: ``arguments`` (text as on the command line, option by option) or ``options``
            (``pkm_post.options.Options``, which replace all settings of the job), ``tool_lengths`` (mm by tool
            number), ``log`` (receives a line for each step) and ``progress`` (``pkm_post.posting.Progress``) for all;
            ``job_name`` for documents, ``reading`` (``pkm_post.reading.ReadingOptions``) for part programs.

    Returns:
        A tuple with a ``pkm_post.posting.Posted`` for each motion program: one, or one for each job of a document.

    Raises:
        pkm_post.model.Refused: something in the input or the folder does not allow it, or there is not enough memory
            (F130). If a document has several jobs, those already posted remain; otherwise nothing was written.
        ValueError: the suffix of the file is not known, or there are both arguments and options.
    """
    from os import PathLike
    from pathlib import Path

    from pkm_post.system import memory_guard

    is_path = isinstance(source, str | PathLike)
    with memory_guard(str(source) if is_path else source.Label):
        if is_path and Path(source).suffix.lower() != ".fcstd":
            from pkm_post.posting import post_file

            return (post_file(Path(source), machine, out, **choices),)
        from pkm_post.freecad_app import post_job as jobs

        if is_path:
            return jobs.post_document(Path(source), machine, out, **choices)
        return (jobs.post_job(source, machine, out, **choices),)
