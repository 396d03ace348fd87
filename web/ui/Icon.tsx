import activity from 'lucide-static/icons/activity.svg?raw';
import chevronDown from 'lucide-static/icons/chevron-down.svg?raw';
import chevronLeft from 'lucide-static/icons/chevron-left.svg?raw';
import chevronRight from 'lucide-static/icons/chevron-right.svg?raw';
import chevronUp from 'lucide-static/icons/chevron-up.svg?raw';
import check from 'lucide-static/icons/check.svg?raw';
import dices from 'lucide-static/icons/dices.svg?raw';
import download from 'lucide-static/icons/download.svg?raw';
import flip from 'lucide-static/icons/flip-horizontal-2.svg?raw';
import follow from 'lucide-static/icons/video.svg?raw';
import frame from 'lucide-static/icons/scan.svg?raw';
import folder from 'lucide-static/icons/folder-open.svg?raw';
import ghosts from 'lucide-static/icons/ghost.svg?raw';
import help from 'lucide-static/icons/circle-question-mark.svg?raw';
import imageDown from 'lucide-static/icons/image-down.svg?raw';
import info from 'lucide-static/icons/info.svg?raw';
import maximize from 'lucide-static/icons/move-horizontal.svg?raw';
import music from 'lucide-static/icons/music.svg?raw';
import path from 'lucide-static/icons/spline.svg?raw';
import pause from 'lucide-static/icons/pause.svg?raw';
import pencil from 'lucide-static/icons/pencil.svg?raw';
import person from 'lucide-static/icons/person-standing.svg?raw';
import pin from 'lucide-static/icons/map-pin-plus-inside.svg?raw';
import play from 'lucide-static/icons/play.svg?raw';
import plus from 'lucide-static/icons/plus.svg?raw';
import redo from 'lucide-static/icons/redo-2.svg?raw';
import repeat from 'lucide-static/icons/repeat.svg?raw';
import reset from 'lucide-static/icons/rotate-ccw.svg?raw';
import search from 'lucide-static/icons/search.svg?raw';
import skipBack from 'lucide-static/icons/skip-back.svg?raw';
import skipForward from 'lucide-static/icons/skip-forward.svg?raw';
import sliders from 'lucide-static/icons/sliders-horizontal.svg?raw';
import sparkles from 'lucide-static/icons/sparkles.svg?raw';
import trash from 'lucide-static/icons/trash-2.svg?raw';
import undo from 'lucide-static/icons/undo-2.svg?raw';
import volume from 'lucide-static/icons/volume-2.svg?raw';
import volumeOff from 'lucide-static/icons/volume-x.svg?raw';
import warning from 'lucide-static/icons/triangle-alert.svg?raw';
import close from 'lucide-static/icons/x.svg?raw';
import zoomIn from 'lucide-static/icons/zoom-in.svg?raw';
import zoomOut from 'lucide-static/icons/zoom-out.svg?raw';
import axes from 'lucide-static/icons/axis-3d.svg?raw';
import balance from 'lucide-static/icons/scale.svg?raw';
import blend from 'lucide-static/icons/blend.svg?raw';
import bone from 'lucide-static/icons/bone.svg?raw';
import bothSides from 'lucide-static/icons/unfold-horizontal.svg?raw';
import copy from 'lucide-static/icons/copy.svg?raw';
import feet from 'lucide-static/icons/footprints.svg?raw';
import move3d from 'lucide-static/icons/move-3d.svg?raw';
import paste from 'lucide-static/icons/clipboard-paste.svg?raw';
import pushpin from 'lucide-static/icons/pin.svg?raw';
import rotate3d from 'lucide-static/icons/rotate-3d.svg?raw';
import otherSide from 'lucide-static/icons/arrow-left-right.svg?raw';
import turn from 'lucide-static/icons/orbit.svg?raw';
import globe from 'lucide-static/icons/globe.svg?raw';
import lock from 'lucide-static/icons/lock.svg?raw';
import lockOpen from 'lucide-static/icons/lock-open.svg?raw';
import distribute from 'lucide-static/icons/align-horizontal-distribute-center.svg?raw';
import duplicate from 'lucide-static/icons/copy-plus.svg?raw';
import bookmark from 'lucide-static/icons/bookmark.svg?raw';
import more from 'lucide-static/icons/ellipsis.svg?raw';
import rename from 'lucide-static/icons/text-cursor-input.svg?raw';
import upload from 'lucide-static/icons/upload.svg?raw';
import locate from 'lucide-static/icons/locate-fixed.svg?raw';
import fileOut from 'lucide-static/icons/file-output.svg?raw';
import share from 'lucide-static/icons/share-2.svg?raw';

const ICONS = {
  share,
  bookmark,
  more,
  rename,
  upload,
  lock,
  lockOpen,
  distribute,
  duplicate,
  locate,
  axes,
  balance,
  blend,
  bone,
  bothSides,
  copy,
  feet,
  move3d,
  paste,
  pushpin,
  rotate3d,
  otherSide,
  turn,
  globe,
  activity,
  check,
  chevronDown,
  chevronLeft,
  chevronRight,
  chevronUp,
  close,
  dices,
  download,
  flip,
  fileOut,
  folder,
  follow,
  frame,
  ghosts,
  help,
  imageDown,
  info,
  maximize,
  music,
  path,
  pause,
  pencil,
  person,
  pin,
  play,
  plus,
  redo,
  repeat,
  reset,
  search,
  skipBack,
  skipForward,
  sliders,
  sparkles,
  trash,
  undo,
  volume,
  volumeOff,
  warning,
  zoomIn,
  zoomOut,
};

/** Names of the icons. */
export type IconName = keyof typeof ICONS;

/** A decorative icon; the button around it carries the name. */
export function Icon({ name, size = 20 }: { name: IconName; size?: number }) {
  return (
    <span
      class="icon"
      aria-hidden="true"
      style={{ width: `${size}px`, height: `${size}px` }}
      dangerouslySetInnerHTML={{ __html: ICONS[name] }}
    />
  );
}
