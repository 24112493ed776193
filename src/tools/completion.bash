# SPDX-License-Identifier: LGPL-2.1-or-later
# Completes subcommands and options of gst-lidar's programs, as their --help names them.
_gst_lidar() {
  local cur prev words cword
  _init_completion || return
  local word command=() help
  for word in "${words[@]:1:cword-1}"; do
    [[ $word =~ ^[a-z][a-z-]*$ ]] && "${words[0]}" "$word" --help >/dev/null 2>&1 && command=("$word") && break
  done
  help=$("${words[0]}" "${command[@]}" --help 2>/dev/null)
  if [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE '^ +(-[a-z],)?--[a-z0-9-]+' <<<"$help" | grep -oE '\-\-[a-z0-9-]+')" -- "$cur")
  elif [ ${#command[@]} = 0 ] && grep -q '^Subcommands:' <<<"$help"; then
    mapfile -t COMPREPLY < <(compgen -W "$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\).*/\1/p' <<<"$help")" -- "$cur")
  else
    _filedir
  fi
}
complete -F _gst_lidar lidar-edge lidar-link lidar-trace scream-bench lidar-eval ouster-replay lidar-dtls-launch lidar-rtsp-launch lidar-webrtc-launch lidar-worker
