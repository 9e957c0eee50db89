# bash completion of talus and talusd: subcommands and options are read from --help, so they are always current.

# Options of a command line such as `talus run`.
_talus_options() {
  "$@" --help 2>/dev/null | sed -n 's/^  *\(-[a-zA-Z], *\)\{0,1\}\(--[a-z-]*\).*/\2/p'
}

_talus_verbs() {
  "$1" --help 2>/dev/null | sed -n '/^Commands/,/^$/s/^  \([a-z]*\) .*/\1/p'
}

# Keys that --set takes, each with its equals sign; or the words that one key takes.
_talus_keys() {
  "$1" schema --keys 2>/dev/null | cut -f 1 | sed 's/$/=/'
}
_talus_words_of_key() {
  "$1" schema --keys 2>/dev/null | awk -F '\t' -v key="$2" '$1 == key { print $3 }'
}

# Job IDs of the server, newest first; nothing where none answers.
_talus_jobs() {
  "$1" status 2>/dev/null | cut -d ' ' -f 1
}

# Case files here, and the installed ones whose name begins like the word.
_talus_cases() {
  compgen -f -X '!*.json' -- "$1"
  compgen -d -- "$1"
  local shipped
  for shipped in "${TALUS_CASES:-/usr/share/talus/cases}/$1"*.json; do
    [ -e "$shipped" ] && echo "$shipped"
  done
}

_talus_values() {
  case $1 in
    case) _talus_cases "$2" ;;
    file) compgen -f -- "$2" ;;
    directory) compgen -d -- "$2" ;;
    *) compgen -W "$1" -- "$2" ;;
  esac
}

# What may stand behind an option, or nothing known.
_talus_argument_of() {
  case $1 in
    --out | --xi | --slurm | --token-file | --tokens | --config | --talus) echo file ;;
    --executor) echo local slurm ;;
    --data | --models) echo directory ;;
    --quantity) echo influence_zone_m front_connected_m front_mass_99_m front_mass_999_m centre_of_mass_x_m front_at_thickness_m ;;
    --integrators) echo rk2 leapfrog ;;
    --yields) echo elastic regularized ;;
    --precisions) echo single double ;;
    --new-token) echo submit read ;;
    --json | --resume | --figures | --retry-failed | --no-figures | --prepare | --from-runs | --watch | --keys | --walls | --spread) return 1 ;;
    --*) echo "" ;;
    *) return 1 ;;
  esac
}

_talus() {
  local program=$1 word=$2 previous=$3 verb="" wanted
  [ "$COMP_CWORD" -gt 1 ] && [ "${program##*/}" = talus ] && verb=${COMP_WORDS[1]}
  COMPREPLY=()
  if [[ $word == = ]]; then  # bash parts words at the equals sign
    word="" previous="="
    COMP_WORDS+=("")
    COMP_CWORD=$((COMP_CWORD + 1))
  fi
  if [[ $previous == = && ${COMP_WORDS[COMP_CWORD - 3]} == --set ]]; then
    wanted=$(_talus_words_of_key "$program" "${COMP_WORDS[COMP_CWORD - 2]}")
  elif [[ $previous == --set ]]; then
    wanted=$(_talus_keys "$program")
    compopt -o nospace 2>/dev/null
  elif wanted=$(_talus_argument_of "$previous"); then
    :
  elif [[ $word == -* ]]; then
    wanted=$(_talus_options "$program" ${verb:+"$verb"})
  else
    case ${program##*/}:$verb in
      talus: | talus:help) wanted=$(_talus_verbs "$program") ;;
      talus:schema) wanted=$("$program" schema) ;;
      talus:stats | talus:profile) wanted=directory ;;
      talus:status | talus:watch | talus:results | talus:cancel) wanted=$(_talus_jobs "$program") ;;
      talus:validate | talus:run | talus:field | talus:study | talus:submit | talus:bench | talus:plot) wanted=case ;;
      *) wanted="" ;;
    esac
  fi
  case $wanted in case | file | directory) compopt -o filenames 2>/dev/null ;; esac
  mapfile -t COMPREPLY < <(_talus_values "$wanted" "$word")
}

complete -F _talus talus talusd
