#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# After all tasks of an array: the summary of all shards. Arguments as for array.sh.
exec "${SKETCHSPLAT:-sketchsplat}" batch "$@" --merge
