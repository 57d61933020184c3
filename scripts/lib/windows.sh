# shellcheck shell=bash
# Makes a Windows Python that runs under wine; sourced after setup.sh, by scripts/test.
#
#   windows_setup      makes it in .venv-windows, with what the checks need: requirements/dev.lock
#   windows_python ARGS...
#                      runs it; this checkout is on its path
#
# The interpreter's DLL and compiled modules are those that panda3d's wheel has for frozen programs; its
# standard library is .venv's own, which is the same on all systems; zig links python.exe.

windows=$root/.venv-windows
debian_windows_packages=(wine wine64)
# Those that hold everywhere; the others start processes as forks, need JACK, or have not been tried.
windows_tests=(tests/live/midi/test_routes.py tests/live/midi/test_systems.py tests/params tests/scores
    tests/surfaces tests/test_config.py tests/test_files.py tests/test_helper_processes.py tests/test_renders.py
    tests/test_systems.py)
export WINEPREFIX=$windows/prefix WINEDEBUG=-all WINEARCH=win64

windows_setup() {
    local made_from
    made_from="$(fingerprint) $(cksum <"$root/scripts/lib/windows.sh") $(cksum <"$root/scripts/lib/windows_binaries.py")"
    [ "$(cat "$windows/stamp" 2>/dev/null)" = "$made_from" ] && return
    mkdir -p "$windows"
    log=$windows/setup.log
    system_packages "${debian_windows_packages[@]}"
    if ! command -v wine >/dev/null; then
        echo 'wine is not here'
        return 77
    fi
    say "making a Windows Python in ${windows##*/}"
    rm -rf "$windows"/{stamp,tools,frozen,python,prefix}
    (windows_install) && printf '%s\n' "$made_from" >"$windows/stamp"
}

windows_install() {
    local python=$windows/python version settings packages
    version=$("$venv/bin/python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    PATH=$venv/bin:$PATH
    export UV_LINK_MODE=copy # what wine needs is written into files, which uv's cache would share
    bring_uv
    settings=$(settings_of_pip "$venv/bin/python")
    packages=$python/Lib/site-packages

    install_packages --target "$windows/tools" ziglang pefile || return
    install_packages --target "$windows/frozen" --no-deps --python-platform windows panda3d || return
    mkdir -p "$python/DLLs" "$packages"
    # But for what others have installed there, which may be much.
    find "$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("stdlib"))')" -mindepth 1 -maxdepth 1 \
        ! -name '*-packages' ! -name lib-dynload ! -name test -exec cp -r -t "$python/Lib" {} +
    install_packages --target "$packages" --python-platform windows --require-hashes \
        --only-binary :all: -r requirements/dev.lock || return
    windows_libraries "$packages"
    # Of this package, what an editable install has: its commands by their names.
    cp -r "$venv"/lib/python*/site-packages/yehu_server-*.dist-info "$packages/"

    cp "$windows"/frozen/deploy_libs/*.dll "$python/"
    cp "$windows"/frozen/deploy_libs/{*.pyd,lib*.dll} "$python/DLLs/"
    rm -f "$python"/api-ms-win-crt-*.dll # wine has its own
    # Where it looks: PYTHONPATH has no say then.
    printf '%s\r\n' Lib DLLs 'Lib\site-packages' "$(windows_path "$root")" . >"$python/python${version/./}._pth"
    logged "$venv/bin/python" scripts/lib/windows_binaries.py "$windows" || return
    rm -rf "$windows"/{frozen,linked}
}

# Adds the DLLs of sound: uv prefers the wheels of these two that have none.
windows_libraries() {
    local name
    for name in soundfile sounddevice; do
        locked "$name" requirements/dev.lock
    done >"$windows/sound.lock"
    rm -rf "$1"/soundfile-*.dist-info "$1"/sounddevice-*.dist-info
    logged pip_install --require-hashes --no-deps --upgrade --target "$1" --platform win_amd64 \
        --only-binary :all: -r "$windows/sound.lock"
}

windows_path() {
    local path=Z:$1
    printf '%s\n' "${path//\//\\}"
}

# wine's programs need a standard input, and write to a pipe alone.
windows_python() {
    set -o pipefail
    NUMBA_CACHE_DIR=$(windows_path "${windows_cache:-$windows/cache}") \
        wine "$windows/python/python.exe" "$@" </dev/null 2>&1 | cat
}
