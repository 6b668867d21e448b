"""Random small MJCF models as text, and the same model with some numbers changed: the machine that makes the logs."""
import random
from xml.sax.saxutils import quoteattr

# What an effect of ours may get as values, in a model of links of 0.1 m and 0.1 kg: {binding: {effect: values}}.
EFFECTS = {
    "joint": {
        "coulomb": {"tau_c": 0.01}, "stribeck": {"tau_mu": 0, "tau_c": 0.01, "S": 0.4, "v_d": 0.2},
        "load_friction": {"tau_c": 0.01, "mu_l": 0.1}, "position_friction": {"tau_c": 0.02, "c": 0.005, "s": 0.005},
        "dahl": {"sigma": 2, "f": 0.02}, "lugre": {"sigma_0": 2, "sigma_1": 0.01, "tau_c": 0.01, "S": 0.3, "v_s": 0.1},
        "bouc_wen": {"kappa_w": 0.02, "rho": 50, "sigma": 1, "n": 1, "eta": 1}, "cubic_stiffness": {"k3": 0.3},
        "maxwell": {"k_m": 0.2, "tau_m": 0.3}},
    "position": {"backlash": {"gap": 0.03}, "pt2": {"w": 40, "zeta": 0.7}},
    "motor": {"pt2": {"w": 40, "zeta": 0.7}},
    "spatial": {"capstan": {"mu": 0.15}, "tendon_stretch": {"compliance": 1e-4}, "slack": {"length": 0.002},
                "coulomb": {"tau_c": 0.05}},
}
OWNERS = {"coulomb", "stribeck", "load_friction", "position_friction"}  # of a joint's dry friction: one at a time


def number(value):
    return f"{value:.6g}"


class Model:
    """`xml` is the user's model, `truth` the machine. Names and what can be measured stand beside them."""

    def __init__(self, draw: random.Random):
        self.draw, self.xml, self.truth = draw, "", ""
        self.joints, self.bodies, self.sites, self.tendons = [], [], [], []
        self.inputs, self.sensors = [], []  # (signal, unit, amplitude, whether it only pulls); (sensor, unit)
        self.places = {}
        self.changed = []
        self.contacts, self.effects = draw.random() < 0.25, ""
        self.body_part()
        tendons, actuators = self.tendon_part(), self.actuator_part()
        sensors, keys = self.sensor_part(), self.keyframe()
        self.both(tendons + actuators + sensors + keys + "</mujoco>\n", head=self.head())

    def chance(self, share):
        return self.draw.random() < share

    def both(self, text, head=""):
        """Adds marked text; in marks ⟦user|truth⟧ stand a number of the model and that of the machine."""
        self.marked = head + getattr(self, "marked", "") + text
        self.xml, self.truth = (self.side(s) for s in (0, 1))

    def side(self, which):
        parts = self.marked.split("⟦")
        return parts[0] + "".join(p.split("⟧")[0].split("|")[which] + p.split("⟧")[1] for p in parts[1:])

    def number(self, what, value, share=0.3):
        """A number of the model that is another one in the machine, at times."""
        true = value
        if self.chance(share):
            true = value * self.draw.choice([0.4, 0.7, 1.3, 2])
            self.changed.append(f"{what}: {number(value)} -> {number(true)}")
        return f"⟦{number(value)}|{number(true)}⟧"

    def head(self):
        d = self.draw
        step = d.choice([0.001, 0.002, 0.002, 0.004, 0.005])
        integrator = d.choice(["implicitfast", "implicitfast", "Euler", "implicit", "RK4"])
        flags = d.choice(["", "", "", '<flag contact="disable"/>', '<flag island="disable"/>',
                          '<flag limit="disable"/>'])
        gravity = ' gravity="0 0 0"' if self.chance(0.25) else ""
        option = f'<option timestep="{step}" integrator="{integrator}"{gravity}>{flags}</option>\n'
        effects = f"<extension>{self.effects}</extension>\n" if self.effects else ""
        return "<mujoco model=\"random\">\n" + option + effects

    # Bodies and joints.
    def body_part(self):
        d = self.draw
        self.marked = "<worldbody>\n"
        if self.contacts:
            height = number(d.uniform(-0.5, -0.1))
            self.marked += f'<geom name="floor" type="plane" size="3 3 .1" pos="0 0 {height}"/>\n'
        self.marked += '<site name="base" pos="0 .03 .03"/>\n'
        count, open_bodies = d.randint(1, 6), 0
        for i in range(count):
            back = open_bodies and (d.randint(1, open_bodies) if self.chance(0.25) else 0)
            self.marked += "</body>\n" * back
            open_bodies -= back
            self.body(i, at_root=open_bodies == 0, last=i == count - 1)
            open_bodies += 1
        self.marked += "</body>\n" * open_bodies
        if self.chance(0.08):
            self.loose_body()
        self.marked += "</worldbody>\n"

    def body(self, i, at_root, last):
        d, name = self.draw, f"link{i}"
        place = f"0 {number(0.3 * i)} 0" if at_root else "0 0 -.1"
        self.bodies.append(name)
        self.marked += f'<body name="{name}" pos="{place}">'
        if last and i and self.chance(0.05):
            self.marked += f'<joint name="ball{i}" type="ball" damping="{self.number("ball damping", 0.02)}"/>'
            self.places["ball"] = f"ball{i}"
        else:
            self.joint(i)
        touches = "" if self.contacts and self.chance(0.7) else ' contype="0" conaffinity="0"'
        self.marked += (f'<geom type="capsule" size=".012" fromto="0 0 0 0 0 -.1" '
                        f'mass="{self.number(f"{name} mass", d.uniform(0.03, 0.3))}"{touches}/>'
                        f'<site name="s{i}" pos=".02 {number(d.choice([0, 0.01, 0.03]))} -.06"/>\n')
        self.sites.append(f"s{i}")

    def joint(self, i):
        d, name = self.draw, f"j{i}"
        slide = self.chance(0.25)
        axis = d.choice(["0 1 0", "0 1 0", "1 0 0", "0 0 1", "0 1 .2"])
        text = f'<joint name="{name}" type="{"slide" if slide else "hinge"}" axis="{axis}"'
        if not self.chance(0.05):
            text += f' damping="{self.number(f"{name} damping", d.uniform(0.01, 0.1) * (10 if slide else 1))}"'
        if self.chance(0.5) or slide:
            text += f' stiffness="{self.number(f"{name} stiffness", d.uniform(0.2, 3) * (50 if slide else 1))}"'
        if self.chance(0.3):
            text += f' armature="{self.number(f"{name} armature", d.choice([0.0005, 0.002, 0.01]))}"'
        if self.chance(0.2):
            text += f' range="{"-.04 .04" if slide else d.choice(["-30 30", "-90 20", "-5 170"])}"'
        if self.chance(0.15):
            text += f' springref="{".01" if slide else "12"}"'
        taken = self.chance(0.15)
        if taken:
            text += f' frictionloss="{self.number(f"{name} frictionloss", 0.01)}"'
        elif self.chance(0.25):
            text += "⟦| frictionloss=\"0.03\"⟧"
            self.changed.append(f"{name} frictionloss: 0 -> 0.03")
            taken = True
        self.marked += text + "/>"
        self.joints.append((name, slide))
        if self.chance(0.12):
            choices = [e for e in EFFECTS["joint"] if not (taken and e in OWNERS)]
            self.effect("joint", name, d.choice(choices))

    def loose_body(self):
        self.marked += ('<body name="ball" pos="0 -1 1"><freejoint name="free"/><geom type="sphere" size=".03" '
                        f'mass="{self.number("ball mass", 0.1)}"/></body>\n')
        self.places["free"] = "ball"

    def effect(self, binding, place, name):
        key = {"position": "actuator", "motor": "actuator", "spatial": "tendon"}.get(binding, binding)
        config = "".join(f'<config key="{k}" value="{self.number(f"{name} {k}", v) if v and v != 1 else v}"/>'
                         for k, v in EFFECTS[binding][name].items())
        self.effects += (f'<plugin plugin="continuum.{name}"><instance name="{name}_{place}">'
                         f'<config key="{key}" value={quoteattr(place)}/>{config}</instance></plugin>\n')

    # Tendons, actuators, sensors.
    def tendon_part(self):
        d, text = self.draw, ""
        if self.joints and self.chance(0.3):
            chosen = d.sample(self.joints, d.randint(1, min(3, len(self.joints))))
            parts = "".join(f'<joint joint="{j}" coef="{d.choice(["1", "-0.5", "0.02"])}"/>' for j, _ in chosen)
            extra = f' stiffness="{self.number("rod stiffness", 2)}"' if self.chance(0.3) else ""
            text += f'<fixed name="rod"{extra}>{parts}</fixed>\n'
            self.tendons.append("rod")
        for k in range(d.choice([0, 0, 0, 1, 1, 2])):
            sites = "".join(f'<site site="{s}"/>' for s in ["base", *self.sites[:d.randint(1, len(self.sites))]])
            extra = d.choice(["", ' stiffness="30"', ' damping=".5"', ' limited="true" range="0 .9"',
                              ' frictionloss=".02"'])
            text += f'<spatial name="cable{k}" width=".002"{extra}>{sites}</spatial>\n'
            self.tendons.append(f"cable{k}")
            if self.chance(0.3):
                names = [e for e in EFFECTS["spatial"] if not (e == "coulomb" and "frictionloss" in extra)
                         and not (e == "capstan" and sites.count("<site") < 3)]
                self.effect("spatial", f"cable{k}", d.choice(names))
        return f"<tendon>\n{text}</tendon>\n" if text else ""

    def actuator_part(self):
        d, text = self.draw, ""
        targets = [f'joint="{j}"' for j, _ in self.joints] + [f'tendon="{t}"' for t in self.tendons]
        for k, target in enumerate(t for t in targets if not self.chance(0.25)):
            text += self.actuator(f"a{k}", target, pulls="cable" in target)
        return f"<actuator>\n{text}</actuator>\n" if text else ""

    def actuator(self, name, target, pulls):
        d = self.draw
        kinds = ["motor", "position", "velocity", "lag", "integrator", "affine", "muscle", "dcmotor", "pid", "delay"]
        kind = d.choices(kinds, [6, 5, 1, 2, 0.5, 1, 0.4, 0.4, 0.4, 0.6])[0]
        limits = ' ctrlrange="-.5 .5"' if self.chance(0.2) else ""
        limits += ' forcerange="-2 2"' if self.chance(0.15) and kind not in ("dcmotor", "muscle") else ""
        text = {
            "motor": lambda: f'<motor gear="{self.number(f"{name} gear", 0.3)}"',
            "position": lambda: (f'<position kp="{self.number(f"{name} kp", d.choice([1, 4, 20]))}" '
                                 f'kv="{number(d.choice([0, 0.05, 0.3]))}"'),
            "velocity": lambda: f'<velocity kv="{self.number(f"{name} kv", 0.3)}"',
            "lag": lambda: (f'<general dyntype="{d.choice(["filter", "filterexact"])}" '
                            f'dynprm="{self.number(f"{name} lag", 0.04)}" gainprm=".4"'),
            "integrator": lambda: '<general dyntype="integrator" gainprm=".3" actlimited="true" actrange="-1 1"',
            "affine": lambda: '<general gaintype="fixed" gainprm="3" biastype="affine" biasprm="0 -3 -.1"',
            "muscle": lambda: '<muscle lengthrange=".05 1.2" force="2"',
            "dcmotor": lambda: '<dcmotor motorconst=".1" resistance="2"',
            "pid": lambda: '<pid kp="3" kv=".1"',
            "delay": lambda: '<motor gear=".3" delay=".012" nsample="20"',
        }[kind]()
        level = {"muscle": 0.3, "dcmotor": 2}.get(kind, 0.5)
        signals = [f"{name}[0]", f"{name}[1]"] if kind == "pid" else [name]
        self.inputs += [(signal, "1", level, pulls or kind == "muscle") for signal in signals]
        if kind in ("position", "motor") and self.chance(0.15):
            self.effect(kind, name, d.choice(list(EFFECTS[kind])))
        if kind == "muscle":
            limits = ""
        return f'{text} name="{name}" {target}{limits}/>\n'

    def sensor_part(self):
        d, text = self.draw, ""

        def add(tag, name, of, unit, size=1):
            nonlocal text
            text += f'<{tag} name="{name}" {of}/>\n'
            self.sensors += [(name, unit)] if size == 1 else [(f"{name}[{c}]", unit) for c in range(size)]

        for joint, slide in self.joints:
            if self.chance(0.85):
                add("jointpos", f"q_{joint}", f'joint="{joint}"', "m" if slide else "rad")
            if self.chance(0.2):
                add("jointvel", f"v_{joint}", f'joint="{joint}"', "m/s" if slide else "rad/s")
        tip = f'objtype="site" objname="{self.sites[-1]}"'
        add("framepos", "tip", tip, "m", 3)
        if self.chance(0.2):
            add("accelerometer", "acc", f'site="{self.sites[-1]}"', "m/s^2", 3)
        if "free" in self.places:
            add("framepos", "loose", 'objtype="body" objname="ball"', "m", 3)
        for tendon in self.tendons:
            add("tendonpos", f"l_{tendon}", f'tendon="{tendon}"', "m" if "cable" in tendon else "1")
        for name, *_ in (i for i in self.inputs[:2] if "[" not in i[0]):
            if self.chance(0.3):
                add("actuatorfrc", f"f_{name}", f'actuator="{name}"', "1")
        return f"<sensor>\n{text}</sensor>\n"

    def keyframe(self):
        return '<keyframe><key name="home" time="0"/></keyframe>\n' if self.chance(0.15) else ""
