#!/usr/bin/env bash
# Every package that scripts/setup.sh installs is listed, with its licence, in docs/dependencies.md.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# All of setup.sh's options that add packages, as its help lists them.
mapfile -t options < <(scripts/setup.sh --help | grep -oE '^ *scripts/setup\.sh --[a-z0-9-]+' | grep -oE -- '--.*' | grep -vE -- '--(minimal|print)')
# A row: | package, package … | for | licence |
listed="$(awk -F'|' 'NF >= 5 && $4 ~ /[A-Za-z]/ && $4 !~ /licence/ {print $2}' docs/dependencies.md | grep -oE '[a-z0-9.:+-]+' | sort -u)"
missing="$(scripts/setup.sh "${options[@]}" --print | sort -u | comm -23 - <(echo "$listed"))"
[ -z "$missing" ] || die "not in docs/dependencies.md, with what it is for and its licence: $(tr '\n' ' ' <<<"$missing")"
