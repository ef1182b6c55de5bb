#!/bin/sh
# pages.sh PECLET FOLDER: writes the manual pages of peclet and of its verbs, which help2man makes from --help.
set -eu
peclet=$1 folder=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
version=$("$peclet" --version | cut -d ' ' -f 2)

# page NAME SUMMARY [VERB]: writes a page; adds a heading to text behind the options, and a prompt to examples.
page() {
  "$peclet" ${3:+"$3"} --help | awk '
    /^Pages: / { next }  # of this machine
    /^Options:/ { behind = 1 }
    behind == 1 && /^[^ ].*[^:]$/ { print "*Notes*\n"; behind = 2 }
    /^Exit codes:/ { print "*Exit status*\n"; behind = 2; next }
    /^Examples?:/ { print "Examples:"; behind = 3; next }
    behind == 3 && sub(/^  # /, "  ") { print "\n" $0 ":\n"; next }
    behind == 3 && sub(/ *\\$/, "") { begun = $0; next }
    begun != "" { sub(/^ +/, " "); $0 = begun $0; begun = "" }
    behind == 3 && /^  peclet / { sub(/^  /, "  $ ") }
    { print }' >"$work/help"
  help2man --no-info --locale C.UTF-8 --version-string "$version" --name "$2" --include "$here/sections.h2m" \
    --help-option "$work/help" cat >"$work/page"
  title=$(echo "$1" | tr a-z A-Z)
  sed -e "s/^\.TH .*/.TH $title 1 \"\" \"peclet $version\" \"Peclet manual\"/" -e "s/^cat \\\\- /$1 \\\\- /" \
    -e 's/^\\f(CW.*/.nf\n&\n.fi/' "$work/page" >"$folder/$1.1"
}

page peclet "$("$peclet" --help | head -n 1)"
"$peclet" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\)  *\(.*\)/\1 \2/p' | while read -r verb summary; do
  page "peclet-$verb" "$summary" "$verb"
done
