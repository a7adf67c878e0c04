#!/usr/bin/env bash
# Draws the README's pictures again: every bundled scenario, planned with seed 1.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
for file in scenarios/*.yaml; do
    name=$(basename "$file" .yaml)
    ellipsoid-planning plan "$name" --seed 1 --output "$folder/$name.json" >/dev/null
    ellipsoid-planning figure "$folder/$name.json" --output "docs/images/$name.png"
done
