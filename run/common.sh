# Lines that the scripts in run/ share; each sources this file first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Modules of a cluster may put other packages before those of .venv.
unset PYTHONPATH PYTHONHOME

# Open MPI 4 and 5 read these, other MPIs do not mind them: start as root too (containers), allow
# more ranks than cores, and tie no rank to a core, since two runs at once would share one.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
export OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_hwloc_default_binding_policy=none

export PATH="$PWD/.venv/bin:$PATH" # `python` is that of .venv

say() { printf "%s\n" "$@"; }

stop() {
    printf '%s\n' "$@" >&2
    exit 1
}
