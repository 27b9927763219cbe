# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power project: a set-up and a program, or kinematics, in the folders of a project of the Power PMAC IDE.

A solution names one project; the project lists its files; ``pp_proj.ini`` gives the order in which the controller loads
them [PowerPMACProjects]. The tree below the project is that of /var/ftp/usrflash/Project. ``save`` in the IDE writes
``pp_save.cfg`` from the controller, so it is not among the files here.

Input: texts by their path in the project. Output: names and texts of all files, reproducible.
"""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from html import escape
from pathlib import PurePosixPath

INCLUDES = "PMAC Script Language/Global Includes"
KINEMATICS = "PMAC Script Language/Kinematic Routines"
MOTION = "PMAC Script Language/Motion Programs"
_FOLDERS = (
    "C Language", "Configuration", "Documentation", "Log", "PMAC Script Language", INCLUDES, KINEMATICS,
    "PMAC Script Language/Libraries", MOTION, "PMAC Script Language/PLC Programs",
)  # fmt: skip
_ROOT = "/var/ftp/usrflash/Project"
_SOLUTION_KIND = "{D6E1C338-3587-4566-BEE3-F0DEB1D41E98}"
"""Project type of this IDE, the same in every public solution."""
_NAMESPACE = uuid.UUID("5c0f3c4e-8f0f-4a53-9d5c-0b7a2c9d6b11")
_BUFFERS = {
    "UserBufSize": 1 << 20,
    "ProgramBufSize": 16 << 20,
    "TableBufSize": 1 << 20,
    "LookAheadBufSize": 16 << 20,
    "SymbolsBufSize": 1 << 20,
}
"""Bytes, as in public projects."""
_PROPERTIES = {
    "SchemaVersion": "2.0",
    "OutputType": "Exe",
    "AssemblyName": "Power Pmac Project Template",
    "EnableUnmanagedDebugging": "false",
    "PVarStart": "8192",
    "QVarStart": "1024",
    "MVarStart": "8192",
    "UserBuffer": "1",
    "ProgramBuffer": "16",
    "TableBuffer": "1",
    "LookAheadBuffer": "16",
    "SymbolsBufSize": "1",
    "RealtimeRoutinesBuildFlag": "0",
    "TemplateVersion": "1.5",
    "ProjppRunAtOption": "No",
    "DownloadCSoruce": "No",
    "EncryptionOption": "Do Not Encrypt Any File",
    "ProjppTimeoutPeriod": "300000",
    "PPCPUType": "armLS1043A;4.1.18-ipipe",
    "CPUType": "arm,LS1043A",
}
"""Properties of a project, in the spelling of the IDE. Without C code the CPU type has no effect here."""
_TASK = (
    'Files="@(Compile)" OutputPath="$(OutputPath)" DebugSymbols="$(DebugSymbols)"'
    ' ProjectPath="$(MSBuildProjectDirectory)" PPCPUType="$(PPCPUType)"'
    ' RealtimeRoutinesBuildFlag="$(RealtimeRoutinesBuildFlag)"'
)


def project_files(name: str, scripts: Mapping[str, str], note: str) -> dict[str, str]:
    """Names and texts of the files of a project, starting at the folder of its solution.

    ``scripts`` are texts by their path below the project, in loading order; ``note`` is that in Documentation.
    """
    texts = {
        **scripts,
        "Configuration/pp_proj.ini": _load_list(scripts),
        "Configuration/pp_startup.txt": "// Commands after the project was loaded: none.\n",
        "Configuration/pp_disable.txt": "// Commands before the project is loaded: none.\n",
        "Documentation/note.txt": note,
    }
    content = "\n".join(f"{place}\n{text}" for place, text in texts.items())
    identity = str(uuid.uuid5(_NAMESPACE, f"{name}\n{content}")).upper()
    made = {f"{name}.PowerPmacSuite_sln": _solution(name, identity)}
    made[f"{name}/{name}.ppproj"] = _project(name, identity, scripts)
    return made | {f"{name}/{place}": text for place, text in texts.items()}


def _load_list(scripts: Mapping[str, str]) -> str:
    files = [f"file{number}={_ROOT}/{place}" for number, place in enumerate(scripts, start=1)]
    sections = {
        "PMAC_PROGRAMS": [
            "PVARSTART=8192", "QVARSTART=1024", "MVARSTART=8192", *files, f"last_file_number={len(files)}",
        ],
        "PROJECT_SETTINGS": ["runatpc=0"],
        "LINUX_PROGRAMS": ["last_program_number=0"],
        "PMAC_BUFFERS": [f"{key}={size}" for key, size in _BUFFERS.items()],
    }  # fmt: skip
    return "".join("\n".join([f"[{section}]", *lines, ""]) for section, lines in sections.items())


def _project(name: str, identity: str, scripts: Mapping[str, str]) -> str:
    properties = {**_PROPERTIES, "ProjectGuid": identity, "RootNamespace": name, "Name": name}
    others = ("pp_disable.txt", "pp_proj.ini", "pp_startup.txt")
    items = [
        *(f'<Folder Include="{_windows(folder)}" />' for folder in _FOLDERS),
        *(f'<Content Include="{_windows(place)}"><SubType>Content</SubType></Content>' for place in scripts),
        *(f'<None Include="Configuration\\{file}" />' for file in others),
        '<Content Include="Documentation\\note.txt" />',
    ]
    return "\n".join(
        [
            '<?xml version="1.0" encoding="utf-8"?>',
            '<Project DefaultTargets="Build" xmlns="http://schemas.microsoft.com/developer/msbuild/2003">',
            "  <PropertyGroup>",
            "    <Configuration Condition=\" '$(Configuration)' == '' \">Debug</Configuration>",
            *(f"    <{key}>{escape(value, quote=False)}</{key}>" for key, value in properties.items()),
            "  </PropertyGroup>",
            *_of_configuration("Debug", "true"),
            *_of_configuration("Release", "false"),
            '  <UsingTask AssemblyFile="$(CompileTaskPath)\\PPMAC460CompileTask.dll"'
            ' TaskName="PPMAC460CompileTask.CompileTask" />',
            "  <ItemGroup>",
            *(f"    {item}" for item in items),
            "  </ItemGroup>",
            '  <Import Project="$(MSBuildBinPath)\\Microsoft.Common.targets" />',
            *(f'  <Target Name="{target}"><CompileTask {_TASK} /></Target>' for target in ("Build", "Rebuild")),
            '  <Target Name="Clean"><RemoveDir Directories="$(OutputPath)" /><MakeDir Directories="$(OutputPath)" />'
            "</Target>",
            "</Project>",
            "",
        ]
    )


def _of_configuration(configuration: str, symbols: str) -> list[str]:
    condition = f"'$(Configuration)|$(Platform)' == '{configuration}|AnyCPU'"
    return [
        f'  <PropertyGroup Condition=" {condition} ">',
        f"    <DebugSymbols>{symbols}</DebugSymbols>",
        f"    <OutputPath>Bin\\{configuration}\\</OutputPath>",
        "  </PropertyGroup>",
    ]


def _solution(name: str, identity: str) -> str:
    platforms = [f"{{{identity}}}.{kind}|Any CPU" for kind in ("Debug", "Release")]
    return "\n".join(
        [
            "",
            "Microsoft Visual Studio Solution File, Format Version 12.00",
            "# PowerPMAC Solution File, Format Version 11.00",
            f'Project("{_SOLUTION_KIND}") = "{name}", "{name}\\{name}.ppproj", "{{{identity}}}"',
            "EndProject",
            "Global",
            "\tGlobalSection(SolutionConfigurationPlatforms) = preSolution",
            *(f"\t\t{kind}|Any CPU = {kind}|Any CPU" for kind in ("Debug", "Release")),
            "\tEndGlobalSection",
            "\tGlobalSection(ProjectConfigurationPlatforms) = postSolution",
            *(f"\t\t{at}.{what} = {at.split('.')[-1]}" for at in platforms for what in ("ActiveCfg", "Build.0")),
            "\tEndGlobalSection",
            "EndGlobal",
            "",
        ]
    )


def _windows(place: str) -> str:
    return escape(str(PurePosixPath(place)).replace("/", "\\"))
