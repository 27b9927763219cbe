# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands: conversion between the ``Path.Command`` lists of CAM operations and programs."""

from pkm_post.freecad_app.commands.reader import read_commands
from pkm_post.freecad_app.commands.writer import commands_of
