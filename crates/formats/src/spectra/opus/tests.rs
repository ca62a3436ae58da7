use super::*;
#[test]
fn dump() {
    for f in std::fs::read_dir("/work/tmp/spec_samples/opus").unwrap() {
        let p = f.unwrap().path();
        if p.extension().unwrap() == "txt" { continue; }
        let all = std::fs::read(&p).unwrap();
        let bytes = Bytes { all: &all, order: ByteOrder::Little };
        let blocks = directory(bytes).unwrap();
        let mut text = String::new();
        for b in blocks.iter().filter(|b| b.is_data()) {
            let pa = blocks.iter().find(|o| o.kind == b.kind | 1 << 4);
            let Some(pa) = pa else { text += &format!("{} no parameters {:x}\n", b.name(), b.kind); continue };
            let pa = Parameters::read(bytes, *pa).unwrap();
            match points(bytes, *b, &pa) {
                Ok(t) => text += &format!("{} {:?} {} {:?} {:?} {:e}\n", b.name(), pa.texts.get("DXU"), t.len(), t[0], t[t.len()-1], t.iter().map(|p| p.1).sum::<f64>()),
                Err(e) => text += &format!("{} error {e} {:?}\n", b.name(), pa.numbers),
            }
        }
        std::fs::write(format!("{}.txt", p.display()), text).unwrap();
    }
}
