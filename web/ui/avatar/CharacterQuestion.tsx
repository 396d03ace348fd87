import { Dialog } from '../Dialog';
import { Icon, type IconName } from '../Icon';
import { useStore } from '../store-context';

/** A file that holds a character and a motion: which of them is wanted? */
export function CharacterQuestion() {
  const store = useStore();
  const { avatarQuestion } = store.state;
  const file = avatarQuestion.value;
  const choose = (use: (file: File) => unknown) => () => {
    const chosen = avatarQuestion.value;
    avatarQuestion.value = null;
    if (chosen) void use(chosen);
  };
  return (
    <Dialog
      open={file !== null}
      onClose={() => (avatarQuestion.value = null)}
      title="Character or motion?"
      titleId="character-question"
      kind="character-question"
    >
      {() => (
        <>
          <p>“{file!.name}” holds a character and a motion. What would you like?</p>
          <div class="character-answers">
            <Answer
              icon="person"
              text="Use the character"
              hint="It dances your dance, in the place of the figure"
              onClick={choose((each) => store.openCharacter(each))}
            />
            <Answer
              icon="activity"
              text="Use the motion"
              hint="Take poses from it, or dance it anew"
              onClick={choose((each) => store.importPoseFile(each))}
            />
          </div>
        </>
      )}
    </Dialog>
  );
}

function Answer(props: { icon: IconName; text: string; hint: string; onClick(): void }) {
  return (
    <button type="button" class="menu-entry" onClick={props.onClick}>
      <Icon name={props.icon} />
      <span>
        {props.text}
        <small>{props.hint}</small>
      </span>
    </button>
  );
}
