#!/usr/bin/env bash
# Every relative link in our Markdown files leads to a file of the tree.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

broken=0
while IFS= read -r -d '' page; do
  while IFS= read -r target; do
    target="${target%%#*}"
    case "$target" in '' | *://* | mailto:*) continue ;; esac
    if [ ! -e "$(dirname "$page")/$target" ]; then
      echo "$page: link to '$target', which does not exist" >&2
      broken=1
    fi
  done < <(grep -oE '\]\([^) ]+' "$page" | cut -c3-)
done < <(find . -name '*.md' -not -path './build/*' -not -path './out/*' -not -path './.git/*' -print0)
exit "$broken"
