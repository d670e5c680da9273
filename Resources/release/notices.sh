# Sourced by release.sh: licenses of the archive's contents, and its bill of materials. Reads `root` (the archive's
# folder), `parts`, `version`, `name`, `epoch` and `origin` (the file of each library except the stubs). Sets `package`
# (the Debian package of each of these).

# Packages whose headers, or font, are compiled in.
header_packages=(fonts-dejavu-core libeigen3-dev libvulkan-dev libvulkan-volk-dev nlohmann-json3-dev)

# find_packages: sets `package`.
find_packages() {
  local file library owner_name names=()
  local -A owner
  for file in "${origin[@]}"; do # dpkg knows files by the path in their package
    names+=("$file" "/usr$file" "$(realpath "$file")" "/usr$(realpath "$file")")
  done
  while read -r owner_name file; do
    owner[$file]=${owner_name%%:*}
  done < <(dpkg-query -S "${names[@]}" 2>/dev/null)
  declare -gA package
  for library in "${!origin[@]}"; do
    for file in "${origin[$library]}" "$(realpath "${origin[$library]}")"; do
      owner_name=${owner[$file]:-${owner[/usr$file]:-}}
      [ -z "$owner_name" ] || package[$library]=$owner_name
    done
    [ -v "package[$library]" ] || die "$library: belongs to no Debian package, so its license is unknown"
  done
}

# list_packages: prints the Debian packages that contribute to the archive, by name.
list_packages() { printf '%s\n' "${package[@]}" "${header_packages[@]}" | sort -u; }

# find_license PACKAGE: prints its SPDX expression from licenses.txt.
find_license() {
  sed -n "s/^${1//./[.]} \{1,\}//p" "$parts/licenses.txt" | grep . ||
    die "$1: has no known license; read /usr/share/doc/$1/copyright and add a line to Resources/release/licenses.txt"
}

# write_notices: writes the copyright file of each package, and the license texts that these reference.
write_notices() {
  local item text
  while read -r item; do
    find_license "$item" >/dev/null
    cp -L "/usr/share/doc/$item/copyright" "$root/licenses/$item.txt" || die "$item: has no copyright file"
  done < <(list_packages)
  cat "$root"/licenses/*.txt | grep -oE '/usr/share/common-licenses/[A-Za-z]+(-[0-9]+(\.[0-9]+)*)?' | sort -u |
    while read -r text; do
      [ ! -e "$text" ] || cp -L "$text" "$root/licenses/common"
    done
}

# print_array ITEM...: prints a JSON array.
print_array() {
  local IFS=,
  printf '[%s]' "$*"
}

# print_package ID NAME VERSION LICENSE PLACE [MORE]: prints a package of the bill.
print_package() {
  printf '\n{"SPDXID":"SPDXRef-%s","name":"%s","versionInfo":"%s","licenseConcluded":"%s","licenseDeclared":"%s",' \
    "$1" "$2" "$3" "$4" "$4"
  printf '"downloadLocation":"%s","filesAnalyzed":false,"copyrightText":"NOASSERTION"%s}' "$5" "${6:-}"
}

# print_url PACKAGE: prints its package URL, as a member of a package of the bill.
print_url() {
  local url=pkg:deb/debian/$1@
  url+=$(dpkg-query -W -f='${Version}\n' "$1" | sed -n 1p)
  url=${url//+/%2B}
  printf ',"externalRefs":[{"referenceCategory":"PACKAGE-MANAGER","referenceType":"purl",'
  printf '"referenceLocator":"%s"}]' "$url"
}

# print_file ID FILE: prints a file of the bill.
print_file() {
  local library=${2##*/} expression=Apache-2.0
  [ ! -v "package[$library]" ] || expression=$(find_license "${package[$library]}")
  printf '\n{"SPDXID":"SPDXRef-%s","fileName":"./%s","licenseConcluded":"%s",' "$1" "${2#"$root"/}" "$expression"
  printf '"copyrightText":"NOASSERTION","checksums":[{"algorithm":"SHA1","checksumValue":"%s"},' \
    "$(sha1sum <"$2" | cut -c1-40)"
  printf '{"algorithm":"SHA256","checksumValue":"%s"}]}' "$(sha256sum <"$2" | cut -c1-64)"
}

# print_relation FROM TYPE TO: prints a relationship of the bill.
print_relation() {
  printf '\n{"spdxElementId":"SPDXRef-%s","relationshipType":"%s","relatedSpdxElement":"SPDXRef-%s"}' "$@"
}

# write_bill: prints the bill of materials (SPDX 2.3, JSON) with the Debian packages and the libraries.
write_bill() {
  local item id source built place file library bill=() files=() relations=()
  bill+=("$(print_package fenestra fenestra "$version" Apache-2.0 NOASSERTION)")
  relations+=("$(print_relation DOCUMENT DESCRIBES fenestra)")
  while read -r item; do
    id=${item//[^A-Za-z0-9.-]/-}
    read -r source built < <(dpkg-query -W -f='${source:Package} ${source:Version}\n' "$item" | sed -n 1p)
    place=https://snapshot.debian.org/package/$source/$built/
    bill+=("$(print_package "$id" "$item" "$built" "$(find_license "$item")" "$place" "$(print_url "$item")")")
    relations+=("$(print_relation fenestra CONTAINS "$id")")
  done < <(list_packages)
  for file in "$root"/lib/* "$root/libexec/fenestra"; do
    library=${file##*/}
    id=File-${library//[^A-Za-z0-9.-]/-}
    files+=("$(print_file "$id" "$file")")
    item=fenestra
    [ ! -v "package[$library]" ] || item=${package[$library]//[^A-Za-z0-9.-]/-}
    relations+=("$(print_relation "$id" GENERATED_FROM "$item")")
  done
  printf '{"spdxVersion":"SPDX-2.3","dataLicense":"CC0-1.0","SPDXID":"SPDXRef-DOCUMENT","name":"%s",' "$name"
  printf '"documentNamespace":"https://spdx.org/spdxdocs/%s-%s",' "$name" \
    "$(cat "$root"/lib/* "$root/libexec/fenestra" | sha256sum | cut -c1-32)"
  printf '"creationInfo":{"created":"%s","creators":["Tool: Fenestra-Resources/release.sh"]},' \
    "$(date -u -d "@$epoch" +%Y-%m-%dT%H:%M:%SZ)"
  printf '"hasExtractedLicensingInfos":[{"licenseId":"LicenseRef-public-domain","name":"Public domain",'
  printf '"extractedText":"Its authors put it into the public domain: licenses/liblzma5.txt."}],\n'
  printf '"packages":%s,\n"files":%s,\n"relationships":%s}\n' \
    "$(print_array "${bill[@]}")" "$(print_array "${files[@]}")" "$(print_array "${relations[@]}")"
}
