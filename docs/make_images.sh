#!/usr/bin/env bash
# Draws the README's pictures again: every bundled scenario, planned with seed 1, and a
# photograph of the page of one (by Chromium, whichever name it goes by).
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
for file in scenarios/*.yaml; do
    name=$(basename "$file" .yaml)
    ellipsoid-planning plan "$name" --seed 1 --output "$folder/$name.json" >/dev/null
    ellipsoid-planning figure "$folder/$name.json" --output "docs/images/$name.png"
done

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
ellipsoid-planning show "$folder/chain-18dof.json" --html "$folder/page.html"
# The clock of the page runs ahead of ours: by 4 s of 8 the robot is half-way.
"$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage \
    --disable-background-networking --enable-unsafe-swiftshader \
    --user-data-dir="$folder/profile" --window-size=1200,800 --virtual-time-budget=4000 \
    --screenshot=docs/images/chain-18dof-page.png "file://$folder/page.html" 2>/dev/null
