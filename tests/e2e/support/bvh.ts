/** A BVH file of our own in three frames: standing, the left arm lowered by a radian, standing. */
export function bvh(): Buffer {
  const limbs = (side: string, x: number) => [
    `JOINT ${side}UpLeg`, `${x * 9} -5 0`, `JOINT ${side}Leg`, '0 -45 0', `JOINT ${side}Foot`, '0 -42 -3', '}', '}', '}',
    `JOINT ${side}Arm`, `${x * 18} 45 0`, `JOINT ${side}ForeArm`, `${x * 26} -1 -2`, `JOINT ${side}Hand`, `${x * 25} 0 0`, '}', '}', '}',
  ]; // prettier-ignore
  const parts = ['ROOT Hips', '0 95 0', 'JOINT Head', '0 65 0', '}', ...limbs('Left', 1), ...limbs('Right', -1), '}'];
  const joints = parts.map((part) =>
    /^[A-Z]/.test(part)
      ? `${part}\n{`
      : part === '}'
        ? part
        : `OFFSET ${part}\nCHANNELS 3 Zrotation Xrotation Yrotation`,
  );
  const names = parts.filter((part) => /^[A-Z]/.test(part));
  const still = names.map(() => '0 0 0').join(' ');
  const lowered = names.map((name) => (name === 'JOINT LeftArm' ? `${-180 / Math.PI} 0 0` : '0 0 0')).join(' ');
  return Buffer.from(
    `HIERARCHY\n${joints.join('\n')}\nMOTION\nFrames: 3\nFrame Time: 0.016667\n${still}\n${lowered}\n${still}\n`,
  );
}
