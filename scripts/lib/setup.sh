# shellcheck shell=bash
# Sets up the checkout's own environment, .venv; sourced by the scripts beside this folder.
#
#   setup run          what yehu-server needs: requirements/run.lock
#   setup dev          that and what the checks need: requirements/dev.lock
#   setup all          that and what the long checks and the site need: requirements/all.lock
#   system_packages [NAMES...]
#                      the system's own libraries and the ones named, where they are missing
#
# A stamp in .venv, written last, holds the hash of what the set-up was made from. A use that
# finds it right runs nothing else; one that does not, sets up again. An interrupted set-up
# leaves no stamp, and two at once take turns. Messages go to stderr; uv's and pip's go to a log, shown
# only on failure. Nothing here relies on `set -e`. Bash 3.2 (macOS) is enough.

root=$(CDPATH='' cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
venv=$root/.venv
log=$venv/setup.log
kinds=(run dev all) # each holds what those before it need
pip_options=(--disable-pip-version-check --no-input --no-compile --progress-bar off)

# What we need from Debian, to play live.
debian_packages=(libportaudio2)
# What only tests need: a JACK server, real OSC senders, a linker for WebAssembly, what runs it and
# the page, and another reader of ABC.
debian_test_packages=(jackd2 liblo-tools puredata-core lld npm chromium chromium-headless-shell
    abcmidi)

# Those first that the tests use most. numba sets the newest.
python_candidates=(python3.12 python3.11 python3.13 python3.14 python3 python)
python_probe='
import sys
if (3, 11) <= sys.version_info[:2] <= (3, 14):
    try:
        from ensurepip import version
        import venv
        print("whole")
    except ImportError:
        print("no venv")
'

say() {
    printf 'yehu: %s\n' "$*" >&2
}

die() {
    say "$@"
    exit 1
}

# Sets up .venv for one of `kinds`, unless that is done already.
setup() {
    local kind=$1 each python fresh=
    is_set_up "$kind" && return

    trap 'exit 130' INT # without a page of pip's log
    python=$(find_python) || exit
    mkdir -p "$venv" || die "cannot write to $root"
    exec 9>>"$venv/.setup.lock" # uv has .lock for its own
    take_turns "$python" || exit
    if ! is_set_up "$kind"; then # another process may have done it while we waited
        if is_reusable; then python=$venv/bin/python; else fresh=yes; fi
        for each in "${kinds[@]}"; do
            is_set_up "$each" || rm -f "$venv/stamp-$each"
        done
        if [ "$fresh" ]; then
            say "setting up .venv with Python $(python_version "$python") (about half a minute), once ..."
            empty_venv
            logged "$python" -I -m venv --without-pip --prompt yehu "$venv"
        elif is_set_up run; then
            say "adding what else is needed"
        else
            say "bringing .venv up to date"
        fi
        install "$kind" "$python" || exit
    fi
    exec 9>&-
    trap - INT
}

# --- is it set up? -----------------------------------------------------------------------

# Prints the hash of all that the set-up of that kind is made from. The absolute paths in it
# make a checkout that was moved set up again, as a virtual environment cannot be moved.
fingerprint() {
    local hash=cksum
    if command -v sha256sum >/dev/null; then hash=sha256sum; fi
    "$hash" "$root"/requirements/*.lock "$root/pyproject.toml" "$root/scripts/lib/setup.sh"
}

is_set_up() {
    [ -x "$venv/bin/python" ] && [ -x "$venv/bin/yehu-server" ] && [ -f "$venv/stamp-$1" ] &&
        [ "$(<"$venv/stamp-$1")" = "$(fingerprint)" ]
}

# Whether .venv is whole, made at this place, and only out of date.
is_reusable() {
    grep -qsF " $root/pyproject.toml" "$venv"/stamp-* || return
    "$venv/bin/python" -I -c '' 2>/dev/null
}

# --- Python ------------------------------------------------------------------------------

# Prints the first usable Python, or $PYTHON where that is set.
find_python() {
    local candidate without_venv=
    if [ "${PYTHON:-}" ]; then python_candidates=("$PYTHON"); fi
    for candidate in "${python_candidates[@]}"; do
        case $("$candidate" -I -c "$python_probe" 2>/dev/null) in
            whole)
                command -v "$candidate" # a path: .venv's comes first in PATH later
                return
                ;;
            'no venv') without_venv=${without_venv:-$(python_version "$candidate")} ;;
        esac
    done
    if [ "$without_venv" ]; then
        die "Python $without_venv lacks its venv module; on Debian:" \
            "sudo apt-get install python${without_venv%.*}-venv"
    elif [ "${PYTHON:-}" ]; then
        die "PYTHON=$PYTHON is not a Python 3.11 to 3.14"
    fi
    die "needs Python 3.11 to 3.14; on Debian: sudo apt-get install python3 python3-venv"
}

python_version() {
    "$1" -I -c 'import platform; print(platform.python_version())'
}

# Holds file descriptor 9 for this process alone, until it is closed.
take_turns() {
    "$1" -I -c '
import fcntl, sys
try:
    try:
        fcntl.flock(9, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print("yehu: waiting for another set-up to finish", file=sys.stderr)
        fcntl.flock(9, fcntl.LOCK_EX)
except OSError:
    pass  # a file system without locks: go on without taking turns
'
}

# --- what goes into .venv ----------------------------------------------------------------

# Removes what an earlier set-up left, but for the lock that we hold and the log.
empty_venv() {
    find "$venv" -mindepth 1 -maxdepth 1 ! -name .setup.lock ! -name "${log##*/}" -exec rm -rf {} +
}

install() (
    trap 'exit 130' INT
    unset PYTHONDONTWRITEBYTECODE
    PATH=$venv/bin:$PATH
    lock=requirements/$1.lock
    made_from=$(fingerprint)
    cd "$root" || exit
    bring_uv "$2"
    settings=$(settings_of_pip "$2")
    install_packages --require-hashes --no-build-isolation -r "$lock"
    if ! is_set_up run; then # else it may be in use
        install_packages --no-deps --no-build-isolation --editable .
        # Loaded once, it leaves bytecode, which a start may not be allowed to.
        logged "$venv/bin/python" -I -c 'import numba, yehu_server.cli.render_one, yehu_server.live.server'
    fi
    # A stamp appears whole or not at all.
    for kind in "${kinds[@]}"; do
        printf '%s\n' "$made_from" >"$venv/stamp.new"
        mv "$venv/stamp.new" "$venv/stamp-$kind"
        if [ "$kind" = "$1" ]; then break; fi
    done
)

# Brings the locked uv, which installs in a fifth of pip's time, unless there is one: by the pip of
# the Python given, if it has one, which saves .venv one of its own.
bring_uv() {
    command -v uv >/dev/null && return
    locked uv requirements/dev.lock >"$venv/uv.lock"
    set -- "${1:-$venv/bin/python}" "${pip_options[@]}" --require-hashes -r "$venv/uv.lock"
    {
        "$1" -I -m pip --python "$venv/bin/python" install "${@:2}" || pip_install "${@:2}"
    } >"$log" 2>&1 </dev/null
}

# Installs by uv; by pip where uv cannot.
install_packages() {
    if command -v uv >/dev/null; then
        (
            eval "$settings"
            uv pip install --python "$venv/bin/python" "$@"
        ) >"$log" 2>&1 </dev/null && return
    fi
    logged pip_install "$@"
}

pip_install() {
    venv_pip install "${pip_options[@]}" "$@"
}

# Runs .venv's pip. Where nothing else can install it, it comes of Python itself, which takes half
# as long as all the rest.
venv_pip() {
    "$venv/bin/python" -I -c 'import pip' 2>/dev/null || "$venv/bin/python" -I -m ensurepip >&2
    "$venv/bin/python" -I -m pip "$@"
}

# Prints pip's settings of its index, as exports for uv, but for extra indexes: of a version that two
# indexes have, uv sees one's files alone, where pip sees both (soundfile's without its library was
# taken so). The Python that .venv was made with may have a pip to ask.
settings_of_pip() {
    { "$1" -I -m pip config list 2>/dev/null || venv_pip config list 2>/dev/null; } |
        "$venv/bin/python" -I -c '
import ast, shlex, sys
names = {"index-url": "UV_DEFAULT_INDEX", "find-links": "UV_FIND_LINKS"}
for line in sys.stdin:
    key, _, value = line.partition("=")
    if name := names.get(key.rpartition(".")[2]):
        print("export", name + "=" + shlex.quote(",".join(ast.literal_eval(value).split())))
'
}

# Prints what a lock file has for one package.
locked() {
    awk -v begin="$1==" '/^[^ ]/ { is_it = index($0, begin) == 1 } is_it' "$2"
}

# Runs a command with its output in the log; shows the end of that and stops if it fails.
logged() {
    "$@" >"$log" 2>&1 </dev/null && return
    tail -n 30 "$log" >&2
    die "set-up failed; the whole log is $log"
}

# --- the system's packages ---------------------------------------------------------------

# Installs what is missing (as root on Debian) or says how to; without it, all but live sound
# works. Only Linux needs this: elsewhere, sounddevice brings PortAudio along.
system_packages() {
    [ "$(uname -s)" = Linux ] || return 0
    # shellcheck disable=SC2046
    set -- $(missing "${debian_packages[@]}" "$@")
    if [ $# -eq 0 ] || apt_install "$@"; then
        return 0
    elif command -v apt-get >/dev/null; then
        say "to play live: sudo apt-get install $*"
    else
        say "to play live, install what Debian calls $*"
    fi
}

# Installs what checks the page, from web/package-lock.json; without it those tests skip.
node_packages() {
    local made_from
    command -v npm >/dev/null || return 0
    made_from=$(cksum <"$root/web/package-lock.json")
    [ "$(cat "$root/web/node_modules/.stamp" 2>/dev/null)" = "$made_from" ] && return
    say "installing what checks the page"
    if (cd "$root/web" && npm ci --ignore-scripts --no-audit --no-fund) >"$log" 2>&1 </dev/null; then
        printf '%s\n' "$made_from" >"$root/web/node_modules/.stamp"
    else
        say "npm ci failed: the page is not tested in a browser"
        tail -n 30 "$log" >&2
    fi
}

# Prints those of the given Debian packages that are not there.
missing() {
    local package
    for package in "$@"; do
        is_there "$package" || printf '%s\n' "$package"
    done
}

is_there() {
    case $1 in
        libportaudio2) # wherever it is from
            case $(PATH=$PATH:/usr/sbin:/sbin ldconfig -p 2>/dev/null) in
                *libportaudio.so.2*) return 0 ;;
            esac
            return 1
            ;;
        npm) command -v npm >/dev/null && command -v node >/dev/null ;;
        *) [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ] ;;
    esac
}

# Installs Debian packages, as root; fails for anyone else.
apt_install() {
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || return
    say "installing $*"
    # One at a time: scripts/test installs its own beside a set-up.
    flock -o "$root/scripts/lib/setup.sh" bash -c 'apt-get update
        DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
    ' apt-get "$@" >"$log" 2>&1 </dev/null 9>&-
}
