# What scripts/reproduce, scripts/scaling and scripts/report_runs have in common: options of their runs, the
# program, and runs that are kept once they are complete. Sourced by them; they set root before.

# The sets of the paper as the program is asked for them, and its scenes, from scripts/data/paper.toml.
read -r paper_partitioners paper_refiners paper_scenes < <(PYTHONPATH=$root/scripts /usr/bin/python3 -c "
from cleave_scripts.results import paper
print(paper.ASKED_PARTITIONERS, paper.ASKED_REFINERS, ','.join(paper.SCENES))")

steps=500 measure_every='' repeats=3 threads=2 seed=1 force=no

fail() {
  echo "${0##*/}: $*" >&2
  exit 1
}

need_count() {
  [[ $2 =~ ^[1-9][0-9]{0,8}$ ]] || fail "$1 is '$2', expected a whole number from 1 to 999999999"
}

# take_option OPTION VALUE: sets the variable of an option that both have.
take_option() {
  case $1 in
    --steps) need_count "$1" "$2"; steps=$2 ;;
    --measure-every) need_count "$1" "$2"; measure_every=$2 ;;
    --repeats) need_count "$1" "$2"; repeats=$2 ;;
    --threads) need_count "$1" "$2"; threads=$2 ;;
    --seed) [[ $2 =~ ^[0-9]{1,18}$ ]] || fail "--seed is '$2', expected a whole number >= 0"; seed=$2 ;;
    --out) out=$2 ;;
  esac
}

# check_steps: what is measured where --measure-every is not given, and whether anything is.
check_steps() {
  : "${measure_every:=$((steps < 10 ? 1 : steps / 10))}"
  ((measure_every <= steps)) || fail "--measure-every is $measure_every, expected at most --steps, $steps"
}

# say_time MINUTES: how long it will take on 2 cores, before it begins.
say_time() {
  echo "${0##*/}: takes about $(($1 > 1 ? $1 : 1)) min on 2 cores, up to 3 more where cleave is not built; what is" \
    "complete is kept" >&2
}

# find_program: sets program, to CLEAVE_PROGRAM or to what is built now.
find_program() {
  if [[ -n ${CLEAVE_PROGRAM:-} ]]; then
    program=$CLEAVE_PROGRAM
    [[ -x $program ]] || fail "CLEAVE_PROGRAM is '$program', which cannot be run"
  else
    "$root/scripts/setup" --preset release --target cleave
    program=$root/build/release/cleave
  fi
}

# keep_or_run DIRECTORY LABEL ARGUMENT...: keeps what is complete, else runs it. Returns what cleave does.
keep_or_run() {
  local directory=$1 label=$2 code=0 text
  local arguments=(run "${@:3}" --steps "$steps" --measure-every "$measure_every" --repeats "$repeats"
    --threads "$threads" --seed "$seed")
  if [[ $force == no ]]; then
    text=$("$root/scripts/is_complete" "$program" "$directory" "${arguments[@]}") || code=$?
    case $code in
      0 | 2) echo "$label is kept: $text; --force runs it again" >&2; return "$code" ;;
      3) fail "$text; give another --out, or --force to overwrite" ;;
      1) code=0; [[ -z $text ]] || echo "$label: $text" >&2 ;;
      *) fail "scripts/is_complete stopped with exit code $code: $text" ;;
    esac
  fi
  echo "$label: $steps steps, measured are $((steps / measure_every))" >&2
  "$program" "${arguments[@]}" --out "$directory" --force
}

# after_run CODE WHAT MANY: notes failed cells in failed_cells, stops where the run did.
failed_cells=no
after_run() {
  case $1 in
    0) ;;
    2) failed_cells=yes ;;
    130) echo "${0##*/}: interrupted; the same command goes on, finished $3 are kept" >&2; exit 130 ;;
    *) fail "cleave stopped with exit code $1 on $2" ;;
  esac
}
