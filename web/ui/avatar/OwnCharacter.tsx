import { AVATAR_FILES } from '../../app/avatar-file';
import type { KeptAvatar } from '../../app/avatar-store';
import { chooseFile } from '../files';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { ToolButton } from '../ToolButton';

/** Who dances: our figure, or one of the visitor's own characters. */
export function OwnCharacter() {
  const store = useStore();
  const { avatar, avatars, avatarJob } = store.state;
  const job = avatarJob.value;
  return (
    <fieldset class="characters">
      <legend>Who dances</legend>
      {avatars.value.length > 0 && (
        <ul>
          <li class="character">
            <label>
              <input
                type="radio"
                name="character"
                checked={avatar.value === null}
                onChange={() => void store.useAvatar(null)}
              />
              <span>Posebeat’s figure</span>
            </label>
          </li>
          {avatars.value.map((each) => (
            <Character key={each.id} character={each} />
          ))}
        </ul>
      )}
      <button
        type="button"
        class="secondary full"
        disabled={job !== null}
        onClick={() => chooseFile(store, AVATAR_FILES, (_, file) => void store.openCharacter(file))}
      >
        <Icon name="upload" />
        {job ? `Opening “${job}” …` : avatars.value.length > 0 ? 'Add a character' : 'Use your own character'}
      </button>
      <p class="hint">
        A VRM or GLB file with a human skeleton, from VRoid, Mixamo or Blender for example. It stays on this device.
      </p>
    </fieldset>
  );
}

function Character({ character: { id, name } }: { character: KeptAvatar }) {
  const store = useStore();
  const chosen = store.state.avatar.value?.id === id;
  return (
    <li class="character">
      <label>
        <input type="radio" name="character" checked={chosen} onChange={() => void store.useAvatar(id)} />
        <span title={name}>{name}</span>
      </label>
      {chosen && (
        <ToolButton
          icon="bone"
          label={`Check the bones of ${name}`}
          title="Check the bones…"
          onClick={() => store.checkBones()}
        />
      )}
      <ToolButton
        icon="trash"
        label={`Remove ${name}`}
        title="Remove from this browser"
        onClick={() => void store.removeAvatar(id)}
      />
    </li>
  );
}
