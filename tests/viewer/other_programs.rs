//! Other programs: drop files on a window, read the clipboard.

use crate::display::Display;
use std::path::Path;
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ConnectionExt as _, EventMask, PropMode, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent,
    SelectionRequestEvent, Window,
};
use x11rb::wrapper::ConnectionExt as _;

/// Version 5 of XDND.
const VERSION: u32 = 5;

impl Display {
    /// Drops files on a window, as a file manager does; returns whether it accepted them.
    pub fn drop_files(&self, window: Window, files: &[&Path]) -> bool {
        let source = self.own();
        let names =
            ["XdndSelection", "XdndEnter", "XdndPosition", "XdndDrop", "XdndFinished", "XdndActionCopy"];
        let [selection, enter, position, drop, finished, copy] = names.map(|name| self.atom(name));
        let uris = self.atom("text/uri-list");
        self.x.set_selection_owner(source, selection, 0u32).unwrap().check().unwrap();
        let list: String = files.iter().map(|path| format!("file://{}\r\n", path.display())).collect();
        self.send_message(window, enter, [source, VERSION << 24, uris, 0, 0]);
        self.send_message(window, position, [source, 0, 100 << 16 | 100, 0, copy]);
        let request = self.wait("no request for the files", |event| match event {
            Event::SelectionRequest(request) => Some(request),
            _ => None,
        });
        self.answer(&request, &list);
        self.send_message(window, drop, [source, 0, 0, copy, 0]);
        self.wait("the drop does not finish", |event| match event {
            Event::ClientMessage(message) if message.type_ == finished => {
                Some(message.data.as_data32()[1] & 1 == 1)
            }
            _ => None,
        })
    }

    /// Answers a request for a selection.
    fn answer(&self, request: &SelectionRequestEvent, text: &str) {
        let SelectionRequestEvent { time, requestor, selection, target, property, .. } = *request;
        let given = self.x.change_property8(PropMode::REPLACE, requestor, property, target, text.as_bytes());
        given.unwrap().check().unwrap();
        let notify = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time,
            requestor,
            selection,
            target,
            property,
        };
        self.x.send_event(false, requestor, EventMask::NO_EVENT, notify).unwrap().check().unwrap();
    }

    /// The text on the clipboard.
    pub fn clipboard(&self) -> String {
        let own = self.own();
        let [clipboard, text] = ["CLIPBOARD", "UTF8_STRING"].map(|name| self.atom(name));
        self.x.convert_selection(own, clipboard, text, text, 0u32).unwrap();
        self.x.flush().unwrap();
        let property = self.wait("no answer with the clipboard", |event| match event {
            Event::SelectionNotify(notify) => Some(notify.property),
            _ => None,
        });
        assert_ne!(property, u32::from(AtomEnum::NONE), "no text on the clipboard");
        let found = self.x.get_property(false, own, property, text, 0, 1 << 16).unwrap().reply().unwrap();
        String::from_utf8(found.value).unwrap()
    }
}
